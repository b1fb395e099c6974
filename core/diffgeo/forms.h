// First and second fundamental forms and the curvatures that follow from them [shapes, section 9].
#pragma once

#include <cmath>
#include <optional>

#include "core/patch/patch.h"

namespace patchmill {

// Unit normal S_u x S_v / |S_u x S_v|. It is nullopt where |S_u x S_v| <= 1e-12 max(|S_u|,|S_v|)^2. There the
// parametrisation is degenerate: the tangents are parallel or, at a pole, one of them is rounding noise.
std::optional<Vec3> UnitNormal(const SurfaceJet& jet);

// UnitNormal, turned so that its z component is >= 0, as a 3-axis tool sees the surface. On a vertical face
// (|e_z| <= FaceSides::upright) it points to the air side if that is known; else it may point either way.
// On a face that overhangs (FaceSides::overhangs) it points to the air side everywhere, also where that is
// down.
std::optional<Vec3> UpwardNormal(const SurfaceJet& jet);

// The side from which a tool reaches a point of the surface.
struct Facing {
  Vec3 e = Vec3::UnitZ();  // UpwardNormal
  bool both = false;  // a vertical face whose air side is unknown: the tool may stand on the side of -e, too
  bool upright = false;    // the place counts as a vertical face: |e_z| <= FaceSides::upright
  bool overhangs = false;  // the place belongs to a face that overhangs: FaceSides::overhangs
};
std::optional<Facing> FacingAt(const SurfaceJet& jet);

// Whether the tool may stand on either side of the surface; `e` is its UpwardNormal.
inline bool HasTwoSides(const SurfaceJet& jet, const Vec3& e) {
  return jet.sides.air_side == 0 && std::abs(e.z()) <= jet.sides.upright;
}

struct FundamentalForms {
  double E = 0, F = 0, G = 0;  // first, mm^2
  double L = 0, M = 0, N = 0;  // second, with respect to `normal`
};
// [shapes (29), (30)]. Signs of L, M, N follow `normal`.
FundamentalForms Forms(const SurfaceJet& jet, const Vec3& normal);

// Normal curvature [shapes (31)] in the direction (du,dv), 1/mm, > 0 concave towards `normal`.
double NormalCurvature(const FundamentalForms& f, double du, double dv);
// Normal curvature in the direction of the 3-D tangent vector t. It need not be a unit vector, and only its
// part in the tangent plane counts.
double NormalCurvature(const FundamentalForms& f, const SurfaceJet& jet, const Vec3& t);

struct PrincipalCurvatures {
  double k_min = 0, k_max = 0;  // k_min <= k_max, 1/mm, > 0 concave towards the normal
};
PrincipalCurvatures Principal(const FundamentalForms& f);

// D = L z_v^2 - 2 M z_u z_v + N z_u^2 [shapes (34)] with the upward normal; < 0 mountain, > 0 basin.
double ContourDeterminant(const SurfaceJet& jet, const FundamentalForms& f);
// kappa_c: normal curvature along the contour [shapes (33)]; 0 where the tangent plane is horizontal (|grad
// z| = 0).
double ContourCurvature(const SurfaceJet& jet, const FundamentalForms& f);

}  // namespace patchmill
