// The functions whose zero curves and limits divide the surface into regions.
#pragma once

#include <vector>

#include "cam/region/reach/reach.h"
#include "core/lines/zero_mesh.h"

namespace patchmill {

// Order matters: limits of reach cost most and are split first, so that the points where other borders are
// cut in need no test; a silhouette (kTurn) is split before the contour curvature, which changes its meaning
// across it [regions, section 2].
enum class Field {
  kFree,       // the ball is free, whatever the floor
  kAbove,      // where it is not: < 0 UNDERCUT, > 0 CONCAVE
  kFloor,      // tip over the floor: < 0 FLOOR
  kTurn,       // SilhouetteField: > 0 where the normal looks up
  kSlope,      // SlopeField of the steep angle: > 0 gentle
  kCurvature,  // ContourCurvatureField: times the sign of kTurn it is < 0 on mountains
  kAllowed,    // < 0 AVOIDED, OUTSIDE or SHANK; only there when something is to be kept in
  kOutside,    // where it is not allowed: < 0 OUTSIDE; only there with kAllowed
  kShank,      // where it is not allowed: < 0 SHANK, > 0 AVOIDED; only there when a wide shank may touch
  kFinished,   // < 0 STRATEGY; only there when passes of one kind are forced upon the surface
};
inline constexpr int kFieldCount = 10;
static_assert(kFieldCount <= kMaxZeroFields);

// Fields in the order of the enum; they keep a reference to `reach`.
std::vector<ZeroField> RegionFields(const ReachTest& reach, const RegionParams& params);

// The first three of them alone: what a ball reaches. Reasons are not told apart: where it is not free kAbove
// is > 0.
std::vector<ZeroField> ReachFields(const ReachTest& reach, const RegionParams& params);

// How finely pieces are divided for them: cells of 0.6 radii, or this part of the diagonal of the surface's
// box where that is more.
ZeroMeshParams RegionMeshParams(const Surface& surface, const RegionParams& params, double part,
                                const RunContext& run);

// What a triangle is; ground that is not finished has no other label than why. Triangles of equal labels that
// share an edge belong together.
struct SplitLabel {
  std::int8_t curvature = 0;  // -1 mountain, +1 basin, 0 flat along the contour (upward normal)
  bool steep = false;
  UnreachableReason reason = UnreachableReason::kNone;
  bool operator==(const SplitLabel&) const = default;
};
SplitLabel LabelOf(const ZeroTriangle& triangle);

}  // namespace patchmill
