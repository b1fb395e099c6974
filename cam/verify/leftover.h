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
  double limit = kInfinity;            // mm; more leftover is a violation. Infinity: the finish is not judged
  double min_step_fraction = 0.25;     // of the centre step on a plane (BeyondStrategy)
  double most = kInfinity;             // mm: no larger leftover is reported, even if nothing is cut at all
};

// The class of a point in the finish. kUnderside means that the outer side of a closed body looks down
// there, and that the tool does not reach the place. kUnwanted means outside a contact boundary or outside
// the part. Patches that are not selected have no root cells.
enum class FinishClass {
  kDone,
  kAboveLimit,
  kUndercut,
  kConcave,
  kFloor,
  kAvoided,
  kStrategy,
  kShank,
  kHolder,
  kOutside,
  kUnderside,
  kUnwanted
};
constexpr FinishClass LastOf(FinishClass) { return FinishClass::kUnwanted; }

struct AreaReport {
  EnumArray<FinishClass, double> area{};       // mm^2
  EnumArray<FinishClass, double> plan_area{};  // mm^2, as seen along Z
  EnumArray<FinishClass, Extreme> deepest;     // largest leftover that was found of each class
  double lowest_center = kInfinity;            // mm, lowest centre height that only the floor forbids
  // mm, largest RaiseNeeded of places that only the shank, or only the holder, blocks; 0: none
  EnumArray<UpperPart, double> raise{};
};

// Measures the area of each class by samples at the middle and the corners of each root cell. A cell whose
// samples differ in class is quartered, at most five times, and less often if there are many such cells:
// about 60,000 cells are spent along the borders of the classes. `lowest_center` is found by a search in the
// piece of the lowest sample that only the floor forbids, `raise` in the same way from the samples with the
// largest RaiseNeeded. So is the deepest leftover of each class that is not to be finished, from its
// deepest sample. `tree` has Metric::kPath and holds the feed moves.
absl::StatusOr<AreaReport> MeasureAreas(const RootedSurface& rooted, const SegmentTree& tree,
                                        const LeftoverParams& params, const RunContext& run);

// Returns the largest value of distance(p, feed moves) + chord_error - R over the reachable points p that
// must be finished. The distance to one move is a convex function of p, and so is a mean of the distances to
// two moves. So over the hull of a cell it is at most its largest value at the control points [verification
// T9]. With the mean of two moves, one on either side of the crest between two passes, the bound is of second
// order [verification T9a].
//
// The value of a cell is that at its middle, if the middle is reachable. A cell is abandoned as unreachable
// if no centre over it can be free. At the border of the reachable set cells are halved down to 2.5 % of the
// radius, or to 0.5 % where the leftover may still rise steeply. `known` is a value that was found before (by
// MeasureAreas).
absl::StatusOr<Extremes> FindLeftover(const RootedSurface& rooted, const SegmentTree& tree,
                                      const LeftoverParams& params, const Extreme& known,
                                      const RunContext& run);

// True if the point is to be finished: it lies in params.where and in the selection.
bool IsWantedAt(const Surface& surface, const LeftoverParams& params, const SurfacePoint& at);

}  // namespace patchmill
