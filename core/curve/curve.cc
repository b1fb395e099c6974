#include "core/curve/curve.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/status.h"
#include "core/math/bspline_basis.h"

namespace patchmill {

CurveJet Evaluate(const HermiteCurve& curve, double t) { return Evaluate(ToBezier(curve), t); }

CurveJet Evaluate(const BezierCurve& curve, double t) {
  BasisJet basis;
  AllBernsteinJet(curve.degree(), t, basis);
  CurveJet jet;
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    jet.p += basis.f[i] * curve.points[i];
    jet.d += basis.d[i] * curve.points[i];
    jet.dd += basis.dd[i] * curve.points[i];
  }
  return jet;
}

CurveJet Evaluate(const BsplineCurve& curve, double t) {
  const auto p = static_cast<std::size_t>(curve.degree);
  const double begin = curve.knots[p], end = curve.knots[curve.knots.size() - 1 - p];
  const double length = end - begin;
  const double x = begin + t * length;
  const int span = FindSpan(curve.knots, curve.degree, x);
  BasisJet basis;
  BsplineBasisJet(curve.knots, curve.degree, span, x, basis);
  CurveJet jet;
  for (std::size_t i = 0; i <= p; ++i) {
    const Vec3& q = curve.points[static_cast<std::size_t>(span) - p + i];
    jet.p += basis.f[i] * q;
    jet.d += length * basis.d[i] * q;
    jet.dd += length * length * basis.dd[i] * q;
  }
  return jet;
}

CurveJet Evaluate(const HosakaSegment& s, double t) {
  CurveJet jet = Evaluate(HermiteCurve{s.origin, s.b, s.origin + s.a, s.c}, t);
  // t^2 (t-1)^2 and its derivatives, times the polynomial, which is evaluated by Horner's rule.
  const double r = t * (t - 1.0), r1 = 2.0 * t - 1.0;
  const double w = r * r, w1 = 2.0 * r * r1, w2 = 2.0 * r1 * r1 + 4.0 * r;
  CurveJet q;
  for (std::size_t k = s.extra.size(); k-- > 0;) {
    q.dd = t * q.dd + 2.0 * q.d;
    q.d = t * q.d + q.p;
    q.p = t * q.p + s.extra[k];
  }
  jet.p += w * q.p;
  jet.d += w1 * q.p + w * q.d;
  jet.dd += w2 * q.p + 2.0 * w1 * q.d + w * q.dd;
  return jet;
}

CurveJet Evaluate(const Curve& curve, double t) {
  return std::visit([t](const auto& c) { return Evaluate(c, t); }, curve);
}

HermiteCurve Reversed(const HermiteCurve& c) { return {c.p1, -c.d1, c.p0, -c.d0}; }

BezierCurve Reversed(BezierCurve curve) {
  std::reverse(curve.points.begin(), curve.points.end());
  return curve;
}

HermiteCurve Part(const HermiteCurve& curve, double t1, double t2) {
  const CurveJet from = Evaluate(curve, t1), to = Evaluate(curve, t2);
  return {from.p, (t2 - t1) * from.d, to.p, (t2 - t1) * to.d};
}

BezierCurve Part(BezierCurve curve, double t1, double t2) {
  const int n = curve.degree();
  if (t2 < 1.0) KeepLeft(curve.points.data(), n, 1, t2);
  if (t1 > 0.0) KeepRight(curve.points.data(), n, 1, t1 / t2);
  return curve;
}

HermiteCurve HermiteOf(const BezierCurve& curve) {
  const auto& p = curve.points;
  const double n = curve.degree();
  return {p.front(), n * (p[1] - p[0]), p.back(), n * (p[p.size() - 1] - p[p.size() - 2])};
}

BezierCurve ToBezier(const HermiteCurve& c) { return {{c.p0, c.p0 + c.d0 / 3.0, c.p1 - c.d1 / 3.0, c.p1}}; }

namespace {

absl::StatusOr<BezierCurve> BezierOf(const HermiteCurve& c) { return ToBezier(c); }
absl::StatusOr<BezierCurve> BezierOf(const BezierCurve& c) { return c; }

absl::StatusOr<BezierCurve> BezierOf(const BsplineCurve& c) {
  const std::vector<int> spans = NonEmptySpans(c.knots, c.degree);
  if (spans.size() != 1) {
    return absl::InvalidArgumentError(
        fmt::format("the B-spline curve has {} spans; must have one to be a Bezier curve", spans.size()));
  }
  BezierCurve bezier;
  for (int j = 0; j <= c.degree; ++j) {
    bezier.points.push_back(BezierPointOfSpan(c.knots, c.degree, spans[0], j, &c.points[0], 1));
  }
  return bezier;
}

absl::StatusOr<BezierCurve> BezierOf(const HosakaSegment& s) {
  const BezierCurve cubic = ToBezier(HermiteCurve{s.origin, s.b, s.origin + s.a, s.c});
  if (s.extra.empty()) return cubic;
  const int k = static_cast<int>(s.extra.size()) - 1, n = 4 + k;
  if (n > kMaxBasisDegree) {
    return absl::InvalidArgumentError(fmt::format("the segment's extra term has {} coefficients; at most {}",
                                                  s.extra.size(), kMaxBasisDegree - 3));
  }
  BezierCurve bezier = Elevated(cubic, n);
  // sum extra_i t^i in degree k has the coefficients j: sum_i extra_i C(j,i)/C(k,i). The factor t^2 (1-t)^2
  // shifts them.
  for (int j = 0; j <= k; ++j) {
    Vec3 q = Vec3::Zero();
    for (int i = 0; i <= j; ++i) {
      q += s.extra[static_cast<std::size_t>(i)] * (Binomial(j, i) / Binomial(k, i));
    }
    bezier.points[static_cast<std::size_t>(j + 2)] += q * (Binomial(k, j) / Binomial(n, j + 2));
  }
  return bezier;
}

}  // namespace

absl::StatusOr<BezierCurve> ToBezier(const Curve& curve) {
  return std::visit([](const auto& c) { return BezierOf(c); }, curve);
}

BezierCurve Elevated(BezierCurve curve, int degree) {
  PM_CHECK(degree >= curve.degree() && degree <= kMaxBasisDegree);
  while (curve.degree() < degree) {
    const int n = curve.degree() + 1;
    std::vector<Vec3> raised(static_cast<std::size_t>(n + 1));
    raised.front() = curve.points.front();
    raised.back() = curve.points.back();
    for (int i = 1; i < n; ++i) {
      const double a = static_cast<double>(i) / n;
      raised[static_cast<std::size_t>(i)] = a * curve.points[static_cast<std::size_t>(i - 1)] +
                                            (1.0 - a) * curve.points[static_cast<std::size_t>(i)];
    }
    curve.points = std::move(raised);
  }
  return curve;
}

}  // namespace patchmill
