#include "core/diffgeo/principal_directions.h"

#include <algorithm>
#include <cmath>

namespace patchmill {

std::optional<PrincipalDirections> DirectionsOf(const SurfaceJet& jet, const FundamentalForms& f) {
  constexpr double kAlike = 1e-9, kLeastTurn = 1e-12;
  const std::optional<Vec3> normal = UnitNormal(jet);
  if (!normal) return std::nullopt;
  // The second form in the orthonormal frame of S_u/|S_u| and its perpendicular: the symmetric matrix (a b; b
  // c), as in Principal.
  const double w2 = f.E * f.G - f.F * f.F;
  const double a = f.L / f.E;
  const double b = (f.E * f.M - f.F * f.L) / (f.E * std::sqrt(w2));
  const double c = (f.E * (f.E * f.N - 2.0 * f.F * f.M) + f.F * f.F * f.L) / (f.E * w2);
  const double mean = 0.5 * (a + c), radius = std::hypot(0.5 * (a - c), b);
  const double step = std::sqrt(std::max(f.E, f.G));
  if (!(radius > kAlike * std::abs(mean)) || !(radius * step > kLeastTurn)) return std::nullopt;
  const double angle = 0.5 * std::atan2(2.0 * b, a - c);  // of the larger curvature, from S_u
  const Vec3 along = jet.du.normalized(), beside = normal->cross(along);
  PrincipalDirections directions;
  directions.max = std::cos(angle) * along + std::sin(angle) * beside;
  directions.min = -std::sin(angle) * along + std::cos(angle) * beside;
  return directions;
}

}  // namespace patchmill
