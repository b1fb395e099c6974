#include "core/diffgeo/forms.h"

#include <algorithm>
#include <cmath>

namespace patchmill {
namespace {

constexpr double kDegenerate = 1e-12;  // height of the parallelogram of S_u, S_v over its longer side
constexpr double kHorizontal = 1e-12;  // sine of the slope below which a contour has no direction

}  // namespace

std::optional<Vec3> UnitNormal(const SurfaceJet& jet) {
  const Vec3 cross = jet.du.cross(jet.dv);
  const double length = cross.norm();
  if (!(length > kDegenerate * std::max(jet.du.squaredNorm(), jet.dv.squaredNorm()))) return std::nullopt;
  return Vec3(cross / length);
}

std::optional<Vec3> UpwardNormal(const SurfaceJet& jet) {
  std::optional<Vec3> normal = UnitNormal(jet);
  if (!normal) return normal;
  const bool turn = jet.sides.Decides(normal->z()) ? jet.sides.air_side < 0 : normal->z() < 0.0;
  if (turn) *normal = -*normal;
  return normal;
}

std::optional<Facing> FacingAt(const SurfaceJet& jet) {
  const std::optional<Vec3> normal = UpwardNormal(jet);
  if (!normal) return std::nullopt;
  const bool upright = std::abs(normal->z()) <= jet.sides.upright;
  return Facing{*normal, HasTwoSides(jet, *normal), upright, jet.sides.overhangs};
}

FundamentalForms Forms(const SurfaceJet& jet, const Vec3& normal) {
  return {jet.du.dot(jet.du),  jet.du.dot(jet.dv),  jet.dv.dot(jet.dv),
          normal.dot(jet.duu), normal.dot(jet.duv), normal.dot(jet.dvv)};
}

double NormalCurvature(const FundamentalForms& f, double du, double dv) {
  const double length2 = f.E * du * du + 2.0 * f.F * du * dv + f.G * dv * dv;
  return (f.L * du * du + 2.0 * f.M * du * dv + f.N * dv * dv) / length2;
}

double NormalCurvature(const FundamentalForms& f, const SurfaceJet& jet, const Vec3& t) {
  // (du, dv) with t = S_u du + S_v dv in the tangent plane, times the common factor EG - F^2, which cancels
  // in [shapes (31)].
  const double tu = t.dot(jet.du), tv = t.dot(jet.dv);
  return NormalCurvature(f, f.G * tu - f.F * tv, f.E * tv - f.F * tu);
}

PrincipalCurvatures Principal(const FundamentalForms& f) {
  // The second form in the orthonormal frame of S_u/|S_u| and its perpendicular is a symmetric matrix (a b; b
  // c). Its eigenvalues need no root of a difference (H^2 - K loses half the digits near umbilics).
  const double w2 = f.E * f.G - f.F * f.F;
  const double a = f.L / f.E;
  const double b = (f.E * f.M - f.F * f.L) / (f.E * std::sqrt(w2));
  const double c = (f.E * (f.E * f.N - 2.0 * f.F * f.M) + f.F * f.F * f.L) / (f.E * w2);
  const double mean = 0.5 * (a + c), radius = std::hypot(0.5 * (a - c), b);
  return {mean - radius, mean + radius};
}

double ContourDeterminant(const SurfaceJet& jet, const FundamentalForms& f) {
  const double zu = jet.du.z(), zv = jet.dv.z();
  return f.L * zv * zv - 2.0 * f.M * zu * zv + f.N * zu * zu;
}

double ContourCurvature(const SurfaceJet& jet, const FundamentalForms& f) {
  const double zu = jet.du.z(), zv = jet.dv.z();
  // |z_v S_u - z_u S_v|^2 = (EG - F^2) sin^2(slope)
  const double length2 = f.E * zv * zv - 2.0 * f.F * zu * zv + f.G * zu * zu;
  const double w2 = f.E * f.G - f.F * f.F;
  if (!(length2 > kHorizontal * kHorizontal * w2)) return 0.0;
  return ContourDeterminant(jet, f) / length2;
}

}  // namespace patchmill
