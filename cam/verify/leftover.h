// [verification P2]: what the feed moves leave standing at reachable points, and how much area is reachable
// at all.
#pragma once

#include <array>

#include "cam/toolpath/segment_tree.h"
#include "cam/verify/extreme.h"
#include "cam/verify/reach.h"

namespace patchmill {

struct LeftoverParams : Finish {
  ReachParams reach;
  double chord_error = 0.0;            // mm: what the segments may be off
  double certainty = 1e-3;             // mm
  const SurfaceMask* where = nullptr;  // the part of the surface that is judged; null: all of it
  double limit = kInfinity;            // mm: more is a violation; infinity: not judged
  double min_step_fraction = 0.25;
  double most = kInfinity;  // mm: reported where nothing is cut at all
};

// What a point is to the finish. kUnwanted: outside a contact boundary or the part; patches that are not
// wanted have no root cells.
enum class FinishClass {
  kDone,
  kAboveLimit,
  kUndercut,
  kConcave,
  kFloor,
  kAvoided,
  kStrategy,
  kShank,
  kOutside,
  kUnwanted
};
inline constexpr std::size_t kFinishClasses = 10;

struct AreaReport {
  std::array<double, kFinishClasses> area{};    // mm^2
  std::array<Extreme, kFinishClasses> deepest;  // largest leftover among the samples of each class
  double lowest_center = kInfinity;             // mm: lowest centre height that only the floor forbids
  double highest_rise = -kInfinity;  // mm: RiseNeeded of all that only the shank keeps the ball from
};

// Areas by sampling: middle and corners of every root cell; cells whose points differ are quartered, the more
// often the fewer there are: about 60,000 cells are spent on the border of the reachable set, at most five
// quarterings. From the lowest sample that only the floor forbids the lowest place is sought in its piece,
// and as well the place that needs the shank highest. `tree` has Metric::kPath and holds the feed moves.
absl::StatusOr<AreaReport> MeasureAreas(const Surface& surface, const std::vector<CellRect>& roots,
                                        const SegmentTree& tree, const LeftoverParams& params,
                                        const RunContext& run);

// Largest dist(p, feed moves) - R over the reachable points. The distance to one segment is convex in p, and
// so is every mean of two: over a cell's hull it is nowhere above its largest value at the control points.
// Two segments, one from each side, make the bound second-order at the crest between two passes. A cell is
// judged by the reachability of its middle and left as unreachable when no centre over it can become free; at
// the border of the reachable set this goes down to cells of 2.5 % of the radius, 0.5 % where it is steep.
// `known` is attained already (from MeasureAreas).
absl::StatusOr<Extremes> FindLeftover(const Surface& surface, const std::vector<CellRect>& roots,
                                      const SegmentTree& tree, const LeftoverParams& params,
                                      const Extreme& known, const RunContext& run);

// The point p at (u,v) is to be finished at all.
bool IsWantedAt(const Surface& surface, const LeftoverParams& params, PieceId piece, double u, double v,
                const Vec3& p);

}  // namespace patchmill
