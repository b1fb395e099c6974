// First global shapes from outline curves [shapes, section 10]: skins through sections, and
// surfaces between four boundary curves. Normals and edges of a network are taken from them.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <absl/status/statusor.h>

#include "core/curve/curve.h"
#include "core/patch/patch.h"

namespace patchmill {

inline constexpr int kMaxSections = 1000;
inline constexpr std::size_t kMaxOutlinePoints = 1'000'000;  // of the surface made

// The B-spline surface through 3..kMaxSections section curves, the same way round: sections lie at lines v =
// const exactly (to about 1e-15 of their size), each with its own parameter as u; across them a cubic spline
// without curvature at the first and the last, in the mean chord between neighbours. Second derivatives are
// continuous along v; along u as those of the sections. Of the highest degree of the sections along u, 3
// along v. FieldError "curves" or "curves[i]" (core/base/error_details.h), as of all surfaces here; also for
// neighbours that are the same curve.
absl::StatusOr<BsplinePatch> SkinSurface(const std::vector<Curve>& sections);

// Boundary curves of a quad in the direction of increasing parameter: v=0, u=1, v=1, u=0. Their ends must
// meet within kMaxCornerGap of the diagonal of their ends; corners are the means.
using BoundaryCurves = std::array<Curve, 4>;
inline constexpr double kMaxCornerGap = 1e-6;

// Bilinearly blended Coons surface, as an exact B-spline surface.
absl::StatusOr<BsplinePatch> CoonsSurface(const BoundaryCurves& outline);

// Hosaka's blended surface [shapes (23), (25)]: across an edge it leaves as the ends of the two neighbouring
// edges do, blended along it; corner twists are zero. Curves of one span, degree up to 11.
absl::StatusOr<HosakaPatch> HosakaSurface(const BoundaryCurves& outline);

}  // namespace patchmill
