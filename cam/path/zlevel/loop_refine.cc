#include "cam/path/zlevel/loop_refine.h"

#include <algorithm>
#include <cmath>

#include "cam/path/chord/chord_bounds.h"
#include "cam/path/chord/chord_supports.h"

namespace patchmill {
namespace {

// Most halvings of a chord.
constexpr int kMaxDepth = 30;
constexpr double kSamePoint = 1e-9;  // mm: points closer than this are one

// Does the chord leave no more than `limit`, judged by the surface between the contacts of its ends? Only
// contacts on one piece can be judged so.
bool ExcessBetween(const LevelOracle& oracle, const LevelPoint& a, const LevelPoint& b, double limit) {
  if (a.contact.piece.value != b.contact.piece.value) return false;
  const double radius = oracle.radius();
  const int parts = SupportParts(radius, (b.q - a.q).norm(), limit);
  const std::vector<Support> between =
      SupportsBetween(oracle.surface(), a.contact, b.contact, parts, -kInfinity);
  return ExcessWithin(
      radius,
      {oracle.Center(a.q), oracle.Center(b.q), {a.contact.p, -kInfinity}, {b.contact.p, -kInfinity}, between},
      limit);
}

class Refiner {
 public:
  Refiner(const LevelOracle& oracle, const LoopTolerance& tolerance, std::vector<LevelPoint>& out)
      : oracle_(oracle),
        tolerance_(tolerance),
        longest_(LongestChord(oracle.radius(), tolerance.gouge)),
        out_(out) {}

  // Appends the points after a, up to and including b.
  void Way(const LevelPoint& a, const LevelPoint& b, const ChainCell& cell, int depth) {
    const double length = (b.q - a.q).norm();
    const double excess = ChordExcess(oracle_, a, b);
    // A chord between two points that touch the surface leaves at most half its length. If a shorter chord
    // seems to leave more, its contact is known no better than the tolerance: it would be divided without
    // end.
    const bool fine = excess <= tolerance_.excess || length <= 2.0 * tolerance_.excess ||
                      (length <= longest_ && ExcessBetween(oracle_, a, b, tolerance_.excess));
    if ((length <= longest_ && fine) || depth >= kMaxDepth || length < kSamePoint || cell.fixed) {
      out_.push_back(b);
      return;
    }
    // Try a corner: beyond it each side has its own contact.
    const double reach = 1.5 * length;
    if (!fine && !OneBranch(a, b)) {
      const std::optional<LevelPoint> corner = oracle_.Corner(a, b, reach);
      if (corner && Between(corner->q, a.q, b.q, cell)) {
        LevelPoint before = *corner, after = *corner;
        before.other.reset();
        after.contact = *corner->other;
        after.other.reset();
        Way(a, before, cell, depth + 1);
        out_.back() = *corner;
        Way(after, b, cell, depth + 1);
        return;
      }
    }
    // Divide into as many parts as the longest chord requires, not always into halves.
    const double parts = std::max(2.0, std::ceil(length / longest_));
    const Vec2 m = a.q + (std::floor(0.5 * parts) / parts) * (b.q - a.q);
    const Vec2 across(Vec2(a.q.y() - b.q.y(), b.q.x() - a.q.x()) / length);
    // Along a free direction a line crosses the graph in the cell, or in one of its bumps beyond an edge.
    // These reach no farther than half the edge ([contours T8c]).
    for (int attempt = cell.Ambiguous() ? 2 : 0; attempt < 3; ++attempt) {
      const Vec2& direction = attempt < 2 ? cell.free : across;
      const double margin = attempt == 1 ? cell.bounds.half.x() : 0.0;
      LevelOracle::Stretch inside = Inside(cell.bounds, margin, m, direction);
      inside.crossed = attempt < 2;
      const std::optional<LevelPoint> root = oracle_.RootOnLine(m, direction, a.contact, b.contact, inside);
      if (!root || (root->q - a.q).norm() < kSamePoint || (root->q - b.q).norm() < kSamePoint) continue;
      Way(a, *root, cell, depth + 1);
      Way(*root, b, cell, depth + 1);
      return;
    }
    // No border point was found near the chord (in a cell without a cone). Its ends are free, so it stays.
    out_.push_back(b);
  }

 private:
  // Do both contacts belong to one smooth branch? Then following one to the other's place arrives there.
  bool OneBranch(const LevelPoint& a, const LevelPoint& b) const {
    return (oracle_.DeepestOnBranch(a.contact, b.q).p - b.contact.p).norm() < 1e-4 * oracle_.radius();
  }

  // Does q lie in the cell and not at an end of the chord? In a cell with a cone it must also lie on the one
  // graph that joins the ends ([contours T8a]).
  static bool Between(const Vec2& q, const Vec2& a, const Vec2& b, const ChainCell& cell) {
    const Vec2 off = (q - cell.bounds.mid).cwiseAbs() - cell.bounds.half;
    if (!((q - a).norm() > kSamePoint && (q - b).norm() > kSamePoint && off.maxCoeff() <= kSamePoint))
      return false;
    return cell.Ambiguous() || Cross(q - a, cell.free) * Cross(b - q, cell.free) > 0.0;
  }

  // Returns the part of a line through m within `margin` of a cell.
  static LevelOracle::Stretch Inside(const XyRect& cell, double margin, const Vec2& m,
                                     const Vec2& direction) {
    LevelOracle::Stretch part{kInfinity, kInfinity};
    for (int k = 0; k < 2; ++k) {
      const double d = direction[k];
      if (d == 0.0) continue;
      const double middle = (cell.mid[k] - m[k]) / d, half = (cell.half[k] + margin) / std::abs(d);
      part.back = std::min(part.back, std::max(0.0, half - middle));
      part.front = std::min(part.front, std::max(0.0, half + middle));
    }
    return part;
  }

  const LevelOracle& oracle_;
  const LoopTolerance& tolerance_;
  double longest_;
  std::vector<LevelPoint>& out_;
};

// Leaves out points where one chord serves: it is short enough for [location T2], and the surface below the
// points passed over and between them bounds the excess.
std::vector<LevelPoint> Thin(const LevelOracle& oracle, const std::vector<LevelPoint>& points, bool closed,
                             const LoopTolerance& tolerance) {
  // Most points that one chord passes over.
  constexpr std::size_t kMostSkipped = 24;
  const std::size_t n = points.size();
  if (n < 4) return points;
  const double longest = LongestChord(oracle.radius(), tolerance.gouge);
  std::vector<LevelPoint> kept;
  // An open polyline ends at its last point, a closed one where it began.
  const std::size_t last = closed ? n : n - 1;
  std::size_t i = 0;
  while (i < last) {
    kept.push_back(points[i]);
    std::size_t best = i + 1;
    for (std::size_t k = i + 2; k <= last && k <= i + kMostSkipped; ++k) {
      if (points[k - 1].other) break;  // corners stay
      const LevelPoint& end = points[k % n];
      if ((end.q - points[i].q).norm() > longest) break;
      LevelPoint start = points[i];
      if (start.other) start.contact = *start.other;
      // Judge each stretch between the places where the chord passes points left out, by the surface there.
      const Vec2 way = end.q - start.q;
      bool good = way.squaredNorm() > 0.0;
      double from = 0.0;
      LevelPoint left = start;
      for (std::size_t s = i + 1; good && s <= k; ++s) {
        const LevelPoint& right = points[s % n];
        const double to = s < k ? (right.q - start.q).dot(way) / way.squaredNorm() : 1.0;
        // The polyline must not move away in plan from the points it passes over either.
        good = to > from && to <= 1.0;
        LevelPoint x = left, y = right;
        x.q = start.q + from * way;
        y.q = start.q + to * way;
        good = good && (ChordExcess(oracle, x, y) <= tolerance.excess ||
                        ExcessBetween(oracle, x, y, tolerance.excess));
        left = right;
        from = to;
      }
      if (good) best = k;
    }
    i = best;
  }
  // A loop with fewer points than this is as small as the tolerance and keeps its shape.
  constexpr std::size_t kFewest = 6;
  if (closed) return kept.size() < kFewest ? points : kept;
  kept.push_back(points[last]);
  return kept;
}

}  // namespace

double ChordExcess(const LevelOracle& oracle, const LevelPoint& a, const LevelPoint& b) {
  // Squared distances to the contacts differ by a linear function along the chord: the caps cross once.
  const double z = oracle.z();
  const auto square = [&](const Vec2& q, const Vec3& k) {
    const double below = std::max(0.0, z - k.z());
    return (q - Xy(k)).squaredNorm() + below * below;
  };
  const double at_a = square(a.q, a.contact.p) - square(a.q, b.contact.p);
  const double at_b = square(b.q, a.contact.p) - square(b.q, b.contact.p);
  double t = 0.5;
  if (at_a != at_b) t = std::clamp(at_a / (at_a - at_b), 0.0, 1.0);
  const Vec2 split = a.q + t * (b.q - a.q);
  return std::max({0.0, oracle.Excess(split, a.contact.p), oracle.Excess(split, b.contact.p)});
}

std::vector<LevelPoint> RefineLoop(const LevelOracle& oracle, const Chain& chain,
                                   const LoopTolerance& tolerance, const RunContext& run) {
  std::vector<LevelPoint> points;
  Refiner refiner(oracle, tolerance, points);
  const std::size_t n = chain.points.size();
  if (!chain.closed) points.push_back(chain.points.front().point);
  for (std::size_t i = 0; i + (chain.closed ? 0 : 1) < n; ++i) {
    if (i % 16 == 0 && run.Cancelled()) return {};
    refiner.Way(chain.points[i].point, chain.points[(i + 1) % n].point, chain.points[i].onward, 0);
  }
  // Start at a corner if there is one, so that thinning cannot cross it.
  const auto corner =
      std::find_if(points.begin(), points.end(), [](const LevelPoint& p) { return p.other.has_value(); });
  if (chain.closed && corner != points.end()) std::rotate(points.begin(), corner, points.end());
  return Thin(oracle, points, chain.closed, tolerance);
}

}  // namespace patchmill
