// First and second fundamental forms and what follows from them (METHODS 1.9, ALGORITHMS 4).
#pragma once

#include <optional>

#include "core/patch/patch.h"

namespace patchmill {

// Unit normal S_u x S_v / |S_u x S_v|; nullopt where |S_u x S_v| <= 1e-12 max(|S_u|,|S_v|)^2: a degenerate
// parametrisation, be it parallel tangents or, at a pole, a tangent that is rounding noise.
std::optional<Vec3> UnitNormal(const SurfaceJet& jet);
// The same, turned so that its z component is >= 0 (what 3-axis work sees; +-normal when z == 0).
std::optional<Vec3> UpwardNormal(const SurfaceJet& jet);

struct FundamentalForms {
  double E = 0, F = 0, G = 0;  // first, mm^2
  double L = 0, M = 0, N = 0;  // second, with respect to `normal`
};
// (24). Signs of L, M, N follow `normal`.
FundamentalForms Forms(const SurfaceJet& jet, const Vec3& normal);

// Normal curvature (25) in the direction (du,dv), 1/mm, > 0 concave towards `normal`.
double NormalCurvature(const FundamentalForms& f, double du, double dv);
// Normal curvature in the direction of the tangent vector t (3-D, need not be unit; its part in the tangent
// plane counts).
double NormalCurvature(const FundamentalForms& f, const SurfaceJet& jet, const Vec3& t);

struct PrincipalCurvatures {
  double k_min = 0, k_max = 0;  // k_min <= k_max, 1/mm, > 0 concave towards the normal
};
PrincipalCurvatures Principal(const FundamentalForms& f);

// D = L z_v^2 - 2 M z_u z_v + N z_u^2 (27) with the upward normal; < 0 mountain, > 0 basin.
double ContourDeterminant(const SurfaceJet& jet, const FundamentalForms& f);
// kappa_c: normal curvature along the contour (26); 0 where the tangent plane is horizontal (|grad z| = 0).
double ContourCurvature(const SurfaceJet& jet, const FundamentalForms& f);

}  // namespace patchmill
