// Measures what the feed moves leave at reachable points [verification P2], and how much area is reachable.
#pragma once

#include "cam/toolpath/segment_tree.h"
#include "cam/verify/extreme.h"
#include "cam/verify/reach.h"
#include "core/base/enum_array.h"

namespace patchmill {

struct LeftoverParams {
  Finish finish;
  ReachParams reach;
  double chord_error = 0.0;            // mm, error of the segments
  double certainty = 1e-3;             // mm
  const SurfaceMask* where = nullptr;  // the part of the surface that is judged; null: all of it
  double limit = kInfinity;            // mm; more is a violation. Infinity: the finish is not judged
  double min_step_fraction = 0.25;     // of the centre step on a plane (BeyondStrategy)
  double most = kInfinity;             // mm, upper limit of what is reported, if nothing is cut at all
};

// How a point counts for the finish. kUnwanted means outside a contact boundary or outside the part. Patches
// that are not selected have no root cells.
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
constexpr FinishClass LastOf(FinishClass) { return FinishClass::kUnwanted; }

struct AreaReport {
  EnumArray<FinishClass, double> area{};    // mm^2
  EnumArray<FinishClass, Extreme> deepest;  // largest leftover among the samples of each class
  double lowest_center = kInfinity;         // mm, lowest centre height that only the floor forbids
  double highest_rise = -kInfinity;         // mm, largest RiseNeeded of places that only the shank blocks
};

// Measures areas by samples at the middle and the corners of each root cell. A cell whose samples differ is
// quartered, at most five times, and less often if there are many such cells: about 60,000 cells are spent on
// the border of the reachable set. From the lowest sample that only the floor forbids, a search in its piece
// finds the lowest place; in the same way it finds the place that needs the highest shank. `tree` has
// Metric::kPath and holds the feed moves.
absl::StatusOr<AreaReport> MeasureAreas(const RootedSurface& rooted, const SegmentTree& tree,
                                        const LeftoverParams& params, const RunContext& run);

// Largest distance(p, feed moves) + chord_error - R over the reachable points. The distance to one segment is
// convex in p, and so is every mean of two such distances. So over a cell's hull it is nowhere above its
// largest value at the control points [verification T9]. With one segment on either side the bound is of
// second order at the crest between two passes [verification T9a]. A cell counts as reachable if its middle
// is. It is abandoned as unreachable if no centre over it can be free. At the border of the reachable set
// this goes down to cells of 2.5 % of the radius, or 0.5 % where the leftover may still rise steeply. `known`
// is a value that was found before (by MeasureAreas).
absl::StatusOr<Extremes> FindLeftover(const RootedSurface& rooted, const SegmentTree& tree,
                                      const LeftoverParams& params, const Extreme& known,
                                      const RunContext& run);

// True if the point is to be finished: it lies in params.where and in the selection.
bool IsWantedAt(const Surface& surface, const LeftoverParams& params, const SurfacePoint& at);

}  // namespace patchmill
