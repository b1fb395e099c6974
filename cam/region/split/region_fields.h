// Makes the fields whose zero curves and limits divide the surface into regions [regions, section 2].
#pragma once

#include <vector>

#include "cam/region/reach/reach.h"
#include "core/lines/zero_mesh.h"

namespace patchmill {

// The fields in the order in which they are cut. Limits of reach cost most and come first, so that points of
// later borders need no test. A silhouette (kTurn) is cut before the contour curvature, whose meaning changes
// across it [regions, section 2].
enum class Field {
  kFree,       // > 0 where the ball is free; the floor does not count
  kAbove,      // where the ball is not free: < 0 UNDERCUT, > 0 CONCAVE
  kFloor,      // height of the tip over the floor: < 0 FLOOR
  kTurn,       // SilhouetteField: > 0 where the normal looks up
  kSlope,      // SlopeField of the steep angle: > 0 gentle
  kCurvature,  // ContourCurvatureField: times the sign of kTurn it is < 0 on mountains
  // A field that the operation does not need is absent if no later one is needed, either.
  kAllowed,   // < 0 where the centre is not allowed (AVOIDED, OUTSIDE, SHANK, HOLDER); needed with limits
  kOutside,   // where the centre is not allowed: < 0 OUTSIDE; present if kAllowed is
  kShank,     // where the centre is not allowed: > 0 AVOIDED; needed for a wide shank or a holder
  kHolder,    // there: < 0 HOLDER; else SHANK where kShank is < 0; present if kShank is
  kFinished,  // < 0 STRATEGY; needed if a strategy is forced
};
inline constexpr int kFieldCount = 11;
static_assert(kFieldCount <= kMaxZeroFields);

// The fields in the order of the enum. They keep a reference to `reach`.
std::vector<ZeroField> RegionFields(const ReachTest& reach, const RegionParams& params);

// The first three of them, which decide what a ball reaches. UNDERCUT and CONCAVE are not distinguished:
// kAbove is > 0 everywhere.
std::vector<ZeroField> ReachFields(const ReachTest& reach, const RegionParams& params);

// How finely pieces are divided for these fields. The largest cell is 0.6 radii, or `part` of the diagonal of
// the surface's box if that is more.
ZeroMeshParams RegionMeshParams(const Surface& surface, const RegionParams& params, double part,
                                const RunContext& run);

// The label of a triangle. If it has a `reason`, the other members keep their defaults. Triangles that have
// equal labels and share an edge belong to one raw region.
struct SplitLabel {
  std::int8_t curvature = 0;  // -1 mountain, +1 basin, 0 flat along the contour (upward normal)
  bool steep = false;
  UnreachableReason reason = UnreachableReason::kNone;
  bool operator==(const SplitLabel&) const = default;
};
SplitLabel LabelOf(const ZeroTriangle& triangle);

}  // namespace patchmill
