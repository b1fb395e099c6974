#include "cam/region/split/reach_limits.h"

#include <algorithm>
#include <vector>

#include "core/diffgeo/forms.h"
#include "core/lines/zero_root.h"

namespace patchmill {
namespace {

constexpr int kMostSlides = 8;   // of one obstacle in one round
constexpr double kWell = 0.2;    // of Bracket::enough: accuracy of the place where an obstacle lets go
constexpr int kFollowed = 6;     // rounds that follow the obstacle; later ones halve the bracket
constexpr int kMostRounds = 60;  // halvings of a double

struct Bracket {
  double blocked = 0.0, free = 1.0, enough = 1.0;  // shares of the segment; `enough` is the wanted width
  double ask = 0.5;                                // share that is tested next
  std::optional<SurfacePoint> obstacle = {};       // in the way at `blocked`
  bool let_go = false;                             // the obstacle lets go exactly at `blocked`

  bool Open() const { return free - blocked > enough; }
};

SurfaceJet At(const Piece& piece, const ZeroSegment& s, double t) {
  const Vec2 q = s.from + t * (s.to - s.from);
  return Evaluate(piece, q.x(), q.y());
}

// The share where the obstacle at `blocked` lets the ball go. Each step slides the obstacle to the deepest
// point of its branch and goes to the share where that point leaves the ball. It lies between `blocked`,
// where the point is in the way, and `free`, where nothing is. This is Newton's method, and no step goes too
// far.
double LetsGo(const ReachTest& reach, const Piece& piece, const ZeroSegment& segment, const Bracket& b) {
  RaySlide obstacle(reach.surface(), *b.obstacle);
  double blocked = b.blocked;
  for (int k = 0; k < kMostSlides; ++k) {
    if (!(reach.Slide(obstacle, At(piece, segment, blocked)) < 0.0)) break;
    const double rest = b.free - blocked;
    const auto clearance = [&](double t) {
      return reach.Clearance(obstacle.at().p, At(piece, segment, blocked + t * rest));
    };
    ZeroBracket let_go(clearance(0.0), clearance(1.0), kWell * b.enough / rest, false);
    while (let_go.Open()) let_go.Put(clearance(let_go.Next()));
    const double step = let_go.Middle() * rest;
    blocked += step;
    if (step < kWell * b.enough || !(blocked < b.free)) break;
  }
  return blocked;
}

}  // namespace

void ReachLimits(const ReachTest& reach, const Piece& piece, std::span<const ZeroSegment> segments,
                 double exact, std::span<double> limits) {
  std::vector<Bracket> brackets(segments.size());
  for (std::size_t k = 0; k < segments.size(); ++k) {
    const double length = (At(piece, segments[k], 1.0).p - At(piece, segments[k], 0.0).p).norm();
    brackets[k].enough = std::max(exact / std::max(length, exact), 1e-13);
  }
  std::vector<std::size_t> open;
  std::vector<SurfaceJet> jets;
  std::vector<double> signs;
  std::vector<std::optional<SurfacePoint>> obstacles;
  for (int round = 0; round < kMostRounds; ++round) {
    open.clear();
    jets.clear();
    for (std::size_t k = 0; k < segments.size(); ++k) {
      Bracket& b = brackets[k];
      if (!b.Open()) continue;
      // The first round finds the obstacle at the start. This costs little, because the finder mostly
      // remembers it.
      b.ask = round == 0 ? 0.0 : 0.5 * (b.blocked + b.free);
      if (b.obstacle && round < kFollowed) {
        b.blocked = LetsGo(reach, piece, segments[k], b);
        b.let_go = true;
        b.ask = b.blocked + 0.5 * b.enough;
        if (!(b.ask < b.free)) continue;
      }
      open.push_back(k);
      jets.push_back(At(piece, segments[k], b.ask));
    }
    if (open.empty()) break;
    signs.resize(open.size());
    obstacles.resize(open.size());
    reach.FreeAt(jets, signs, obstacles);
    for (std::size_t i = 0; i < open.size(); ++i) {
      Bracket& b = brackets[open[i]];
      if (signs[i] > 0.0) {
        b.free = b.ask;
      } else {
        b.blocked = b.ask;
        b.obstacle = obstacles[i];
        b.let_go = false;
      }
    }
  }
  for (std::size_t k = 0; k < segments.size(); ++k)
    limits[k] = brackets[k].let_go ? brackets[k].blocked : 0.5 * (brackets[k].blocked + brackets[k].free);
}

}  // namespace patchmill
