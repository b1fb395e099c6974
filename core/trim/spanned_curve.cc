#include "core/trim/spanned_curve.h"

#include <algorithm>
#include <cstddef>

#include "core/math/bernstein.h"
#include "core/math/bspline_basis.h"

namespace patchmill {

SpannedCurve SpansOf(const BrepCurve& curve) {
  std::vector<Vec4> points;
  points.reserve(curve.points.size());
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    const double w = curve.weights.empty() ? 1.0 : curve.weights[i];
    points.push_back({w * curve.points[i].x(), w * curve.points[i].y(), w * curve.points[i].z(), w});
  }
  SpannedCurve result;
  const int p = curve.degree;
  for (const int k : NonEmptySpans(curve.knots, p)) {
    CurveSpan span{
        curve.knots[static_cast<std::size_t>(k)], curve.knots[static_cast<std::size_t>(k) + 1], {}};
    for (int j = 0; j <= p; ++j) {
      span.points.push_back(
          BezierPointOfSpan(curve.knots, p, k, j, &points[static_cast<std::size_t>(k - p)], 1));
    }
    result.spans.push_back(std::move(span));
  }
  return result;
}

SpacePoint PointAt(const SpannedCurve& curve, double at) {
  const auto after = std::upper_bound(curve.spans.begin() + 1, curve.spans.end(), at,
                                      [](double t, const CurveSpan& span) { return t < span.from; });
  const CurveSpan& span = *(after - 1);
  const int n = static_cast<int>(span.points.size()) - 1;
  const double length = span.to - span.from, t = (at - span.from) / length;
  BasisJet basis;
  AllBernsteinSlopes(n, t, basis);
  Vec4 h = Vec4::Zero(), dh = Vec4::Zero();
  for (int i = 0; i <= n; ++i) {
    h += basis.f[i] * span.points[static_cast<std::size_t>(i)];
    dh += basis.d[i] * span.points[static_cast<std::size_t>(i)];
  }
  const Vec3 p = h.head<3>() / h.w();
  return {p, (dh.head<3>() - dh.w() * p) / (h.w() * length)};
}

}  // namespace patchmill
