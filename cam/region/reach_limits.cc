#include "cam/region/reach_limits.h"

#include <algorithm>
#include <vector>

#include "core/diffgeo/forms.h"
#include "core/lines/zero_root.h"

namespace patchmill {
namespace {

constexpr int kFollowed = 6;     // questions with an obstacle to follow; from then on halving
constexpr int kMostRounds = 60;  // a double has no more

struct Bracket {
  double blocked = 0.0, free = 1.0, enough = 1.0;  // shares of the segment
  double ask = 0.5;
  std::optional<Vec3> obstacle = {};  // in the way at `blocked`

  bool Open() const { return free - blocked > enough; }
};

SurfaceJet At(const Piece& piece, const ZeroSegment& s, double t) {
  const Vec2 q = s.from + t * (s.to - s.from);
  return Evaluate(piece, q.x(), q.y());
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
  std::vector<std::optional<Vec3>> obstacles;
  for (int round = 0; round < kMostRounds; ++round) {
    open.clear();
    jets.clear();
    for (std::size_t k = 0; k < segments.size(); ++k) {
      Bracket& b = brackets[k];
      if (!b.Open()) continue;
      // What is in the way at the start is mostly known to be: it costs little to hear of it.
      b.ask = round == 0 ? 0.0 : 0.5 * (b.blocked + b.free);
      if (b.obstacle && round < kFollowed) {
        // The obstacle lets go between `blocked`, where it is in the way, and `free`, where nothing is.
        const auto clearance = [&](double t) {
          return reach.Clearance(*b.obstacle, At(piece, segments[k], b.blocked + t * (b.free - b.blocked)));
        };
        ZeroBracket let_go(clearance(0.0), clearance(1.0), 0.2 * b.enough / (b.free - b.blocked), false);
        while (let_go.Open()) let_go.Put(clearance(let_go.Next()));
        b.blocked += let_go.Middle() * (b.free - b.blocked);
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
      }
    }
  }
  for (std::size_t k = 0; k < segments.size(); ++k)
    limits[k] = 0.5 * (brackets[k].blocked + brackets[k].free);
}

}  // namespace patchmill
