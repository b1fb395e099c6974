#include "cam/region/split/reach_limits.h"

#include <algorithm>
#include <vector>

#include "core/diffgeo/forms.h"
#include "core/lines/zero_root.h"

namespace patchmill {
namespace {

constexpr int kMostSlides = 8;
constexpr double kWell = 0.2;    // of what is enough
constexpr int kFollowed = 6;     // questions with an obstacle to follow; from then on halving
constexpr int kMostRounds = 60;  // a double has no more

struct Bracket {
  double blocked = 0.0, free = 1.0, enough = 1.0;  // shares of the segment
  double ask = 0.5;
  std::optional<SurfacePoint> obstacle = {};  // in the way at `blocked`
  bool let_go = false;                        // the obstacle lets go exactly there

  bool Open() const { return free - blocked > enough; }
};

SurfaceJet At(const Piece& piece, const ZeroSegment& s, double t) {
  const Vec2 q = s.from + t * (s.to - s.from);
  return Evaluate(piece, q.x(), q.y());
}

// The share where what is in the way at `blocked` lets go. The ball is let go of by one point between
// `blocked`, where that is in its way, and `free`, where nothing is; there the next deepest one of the same
// branch of the surface is: Newton's steps, none too far.
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
      // What is in the way at the start is mostly known to be: it costs little to hear of it.
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
