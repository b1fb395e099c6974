// First global shapes from outline curves [shapes, section 10]: skins through sections, and surfaces between
// four boundary curves. A network can take its normals and edges from them.
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

// The B-spline surface through 3..kMaxSections section curves, which all run in the same direction. Sections
// lie on lines v = const exactly (to about 1e-15 of their size), each with its own parameter as u. Across
// them runs a cubic spline in the mean chord between neighbours, without curvature at the first and the last
// section. Second derivatives are continuous along v; along u they are as continuous as those of the
// sections. The degree along u is the highest of the sections, along v it is 3. Errors, as of all surfaces
// here, are FieldErrors of "curves" or "curves[i]" (core/base/error_details.h); neighbours that are the same
// curve are one, too.
absl::StatusOr<BsplinePatch> SkinSurface(const std::vector<Curve>& sections);

// Boundary curves of a quad, each in the direction of the increasing parameter: v=0, u=1, v=1, u=0. At a
// corner their ends must meet within kMaxCornerGap of the diagonal of the box of all ends. The corner is
// their mean.
using BoundaryCurves = std::array<Curve, 4>;
inline constexpr double kMaxCornerGap = 1e-6;

// The bilinearly blended Coons surface, as an exact B-spline surface.
absl::StatusOr<BsplinePatch> CoonsSurface(const BoundaryCurves& outline);

// Hosaka's blended surface [shapes (23), (25)]. Across an edge it starts with the end derivatives of the two
// neighbouring edges, blended along the edge; corner twists are zero. Needs curves of one span, degree up to
// 11.
absl::StatusOr<HosakaPatch> HosakaSurface(const BoundaryCurves& outline);

}  // namespace patchmill
