#include "core/crossing/drawn_curve.h"

#include <algorithm>

#include "core/base/index.h"
#include "core/curve/spline.h"

namespace patchmill {

absl::StatusOr<BezierChain> ChainThrough(const std::vector<Vec3>& points) {
  std::vector<Vec3> distinct;
  for (const Vec3& p : points) {
    if (!p.allFinite()) return absl::InvalidArgumentError("has a number that is not finite");
    if (distinct.empty() || distinct.back() != p) distinct.push_back(p);
  }
  if (distinct.size() < 2) return absl::InvalidArgumentError("has fewer than two different points");
  const auto spline = SplineThrough(distinct, false);
  if (!spline.ok()) return spline.status();
  BezierChain chain;
  chain.degree = 3;
  chain.breaks = {0.0};
  chain.points = {distinct.front()};
  double total = 0.0;
  for (std::size_t k = 1; k < distinct.size(); ++k) {
    total += (distinct[k] - distinct[k - 1]).norm();
    chain.breaks.push_back(total);
    const std::vector<Vec3> span = ToBezier((*spline)[k - 1]).points;
    chain.points.insert(chain.points.end(), span.begin() + 1, span.end());
  }
  for (double& at : chain.breaks) at /= total;
  chain.breaks.back() = 1.0;
  for (std::size_t k = 1; k < chain.breaks.size(); ++k) {
    if (chain.breaks[k] - chain.breaks[k - 1] < kMinBreakGap) {
      return absl::InvalidArgumentError("has neighbouring points nearer than 1e-9 of its length");
    }
  }
  return chain;
}

}  // namespace patchmill
