#include "core/patch/domain.h"

namespace patchmill {

ParameterDomain DomainOf(const PatchShape& shape) {
  ParameterDomain domain;
  domain.triangle = IsTriangle(shape);
  if (const auto* spline = std::get_if<BsplinePatch>(&shape)) {
    const auto u = static_cast<std::size_t>(spline->degree_u), v = static_cast<std::size_t>(spline->degree_v);
    domain.low = {spline->knots_u[u], spline->knots_v[v]};
    domain.high = {spline->knots_u[spline->knots_u.size() - 1 - u],
                   spline->knots_v[spline->knots_v.size() - 1 - v]};
  }
  return domain;
}

bool Contains(const ParameterDomain& domain, const Vec2& uv) {
  if (domain.triangle) return uv.minCoeff() >= 0.0 && uv.sum() <= 1.0;
  return (uv - domain.low).minCoeff() >= 0.0 && (domain.high - uv).minCoeff() >= 0.0;
}

}  // namespace patchmill
