#include "core/curve/bezier_chain.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/index.h"
#include "core/base/status.h"
#include "core/math/bspline_basis.h"

namespace patchmill {
namespace {

absl::StatusOr<BezierChain> Chain(const BsplineCurve& curve) {
  const int p = curve.degree;
  if (p < 1 || p > kMaxBasisDegree) {
    return absl::InvalidArgumentError(
        fmt::format("a curve has degree {}; must be in [1, {}]", p, kMaxBasisDegree));
  }
  const std::size_t n = curve.points.size();
  if (n <= At(p) || curve.knots.size() != n + At(p) + 1) {
    return absl::InvalidArgumentError(fmt::format(
        "a curve of degree {} has {} points and {} knots; must have at least {} points and {} more knots", p,
        n, curve.knots.size(), p + 1, p + 1));
  }
  const bool rising = std::ranges::all_of(curve.knots, [](double k) { return std::isfinite(k); }) &&
                      std::ranges::is_sorted(curve.knots);
  if (!rising || !(curve.knots[At(p)] < curve.knots[n])) {
    return absl::InvalidArgumentError("a curve has knots that are not finite, decrease, or span nothing");
  }
  for (std::size_t k = At(p) + 1; k + At(p) < n + 1; ++k) {
    if (curve.knots[k] == curve.knots[k + At(p)] && curve.knots[k] > curve.knots[At(p)] &&
        curve.knots[k] < curve.knots[n]) {
      return absl::InvalidArgumentError(fmt::format(
          "a curve of degree {} has the knot {:g} more than {} times: it jumps there", p, curve.knots[k], p));
    }
  }
  const double from = curve.knots[At(p)], length = curve.knots[n] - from;
  BezierChain chain;
  chain.degree = p;
  for (const int k : NonEmptySpans(curve.knots, p)) {
    const Vec3* local = &curve.points[At(k - p)];
    if (chain.points.empty()) {
      chain.breaks.push_back(0.0);
      chain.points.push_back(BezierPointOfSpan<Vec3>(curve.knots, p, k, 0, local, 1));
    }
    for (int j = 1; j <= p; ++j) {
      chain.points.push_back(BezierPointOfSpan<Vec3>(curve.knots, p, k, j, local, 1));
    }
    chain.breaks.push_back((curve.knots[At(k + 1)] - from) / length);
  }
  chain.breaks.back() = 1.0;
  return chain;
}

void Elevate(BezierChain& chain, int degree) {
  if (chain.degree == degree) return;
  std::vector<Vec3> points = {chain.points.front()};
  for (int k = 0; k < chain.spans(); ++k) {
    const std::vector<Vec3> raised = Elevated(SpanOf(chain, k), degree).points;
    points.insert(points.end(), raised.begin() + 1, raised.end());
  }
  chain.degree = degree;
  chain.points = std::move(points);
}

// Index of the common break that a chain's break `at` counts as.
std::size_t IndexOf(const std::vector<double>& breaks, double at) {
  return static_cast<std::size_t>(std::ranges::upper_bound(breaks, at) - breaks.begin()) - 1;
}

absl::Status Refine(BezierChain& chain, const std::vector<double>& breaks) {
  std::vector<Vec3> points = {chain.points.front()};
  for (int k = 0; k < chain.spans(); ++k) {
    const std::size_t from = IndexOf(breaks, chain.breaks[At(k)]),
                      to = IndexOf(breaks, chain.breaks[At(k + 1)]);
    if (from == to) {
      return absl::InvalidArgumentError(
          fmt::format("a curve has knots {:g} and {:g}, nearer than {:g} of its domain", chain.breaks[At(k)],
                      chain.breaks[At(k + 1)], kMinBreakGap));
    }
    const auto first = chain.points.begin() + k * chain.degree;
    std::vector<Vec3> rest(first, first + chain.degree + 1);
    for (std::size_t next = from + 1; next <= to; ++next) {
      std::vector<Vec3> part = rest;
      if (next < to) {
        const double t = (breaks[next] - breaks[next - 1]) / (breaks[to] - breaks[next - 1]);
        KeepLeft(part.data(), chain.degree, 1, t);
        KeepRight(rest.data(), chain.degree, 1, t);
      }
      points.insert(points.end(), part.begin() + 1, part.end());
    }
  }
  chain.points = std::move(points);
  chain.breaks = breaks;
  return absl::OkStatus();
}

}  // namespace

BezierChain AsChain(BezierCurve curve) { return {curve.degree(), {0.0, 1.0}, std::move(curve.points)}; }

BezierCurve SpanOf(const BezierChain& chain, int span) {
  const auto first = chain.points.begin() + span * chain.degree;
  return {{first, first + chain.degree + 1}};
}

namespace {

CurveJet OnSpan(const BezierChain& chain, int k, double t) {
  const double from = chain.breaks[At(k)], length = chain.breaks[At(k + 1)] - from;
  CurveJet jet = Evaluate(SpanOf(chain, k), (t - from) / length);
  jet.d /= length;
  jet.dd /= length * length;
  return jet;
}

}  // namespace

CurveJet Evaluate(const BezierChain& chain, double t) {
  int k = 0;
  while (k + 1 < chain.spans() && chain.breaks[At(k + 1)] <= t) ++k;
  return OnSpan(chain, k, t);
}

std::array<CurveJet, 2> JetsAtBreak(const BezierChain& chain, int k) {
  const double t = chain.breaks[At(k)];
  return {OnSpan(chain, k - 1, t), OnSpan(chain, k, t)};
}

HermiteCurve HermiteOf(const BezierChain& chain) {
  const int last = chain.spans() - 1;
  const HermiteCurve start = HermiteOf(SpanOf(chain, 0)),
                     end = last > 0 ? HermiteOf(SpanOf(chain, last)) : start;
  return {start.p0, start.d0 / chain.breaks[1], end.p1, end.d1 / (1.0 - chain.breaks[At(last)])};
}

BezierChain Reversed(BezierChain chain) {
  std::ranges::reverse(chain.points);
  std::ranges::reverse(chain.breaks);
  for (double& b : chain.breaks) b = 1.0 - b;
  return chain;
}

BezierChain Elevated(BezierChain chain, int degree) {
  Elevate(chain, degree);
  return chain;
}

BezierChain Part(const BezierChain& chain, double t1, double t2) {
  BezierChain part{chain.degree, {0.0}, {}};
  for (int k = 0; k < chain.spans(); ++k) {
    const double a = chain.breaks[At(k)], b = chain.breaks[At(k + 1)];
    const double from = std::max(t1, a), to = std::min(t2, b);
    if (to - from <= kMinBreakGap) continue;
    const std::vector<Vec3> span = Part(SpanOf(chain, k), (from - a) / (b - a), (to - a) / (b - a)).points;
    part.points.insert(part.points.end(), span.begin() + (part.points.empty() ? 0 : 1), span.end());
    part.breaks.push_back((to - t1) / (t2 - t1));
  }
  part.breaks.back() = 1.0;
  return part;
}

BezierChain CutAt(BezierChain chain, const std::vector<double>& breaks) {
  if (chain.breaks != breaks) PM_CHECK(Refine(chain, breaks).ok());
  return chain;
}

std::vector<double> CommonBreaks(const std::vector<BezierChain>& chains) {
  std::vector<double> all;
  for (const BezierChain& chain : chains) all.insert(all.end(), chain.breaks.begin(), chain.breaks.end());
  std::ranges::sort(all);
  std::vector<double> breaks;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (k == 0 || all[k] - all[k - 1] > kMinBreakGap) breaks.push_back(all[k]);
  }
  return breaks;
}

absl::StatusOr<BezierChain> ChainOf(const Curve& curve) {
  if (const auto* spline = std::get_if<BsplineCurve>(&curve)) return Chain(*spline);
  if (const auto* given = std::get_if<BezierCurve>(&curve);
      given != nullptr && (given->degree() < 1 || given->degree() > kMaxBasisDegree)) {
    return absl::InvalidArgumentError(
        fmt::format("a curve has degree {}; must be in [1, {}]", given->degree(), kMaxBasisDegree));
  }
  PM_ASSIGN_OR_RETURN(const BezierCurve bezier, ToBezier(curve));
  return BezierChain{bezier.degree(), {0.0, 1.0}, bezier.points};
}

std::size_t AlikeSize(const std::vector<BezierChain>& chains) {
  int degree = 1;
  for (const BezierChain& chain : chains) degree = std::max(degree, chain.degree);
  return (CommonBreaks(chains).size() - 1) * At(degree) + 1;
}

absl::Status MakeAlike(std::vector<BezierChain>& chains) {
  int degree = 1;
  for (const BezierChain& chain : chains) degree = std::max(degree, chain.degree);
  const std::vector<double> breaks = CommonBreaks(chains);
  for (BezierChain& chain : chains) {
    Elevate(chain, degree);
    PM_RETURN_IF_ERROR(Refine(chain, breaks));
  }
  return absl::OkStatus();
}

std::vector<double> ControlAbscissae(const BezierChain& chain) {
  std::vector<double> t = {0.0};
  for (int k = 0; k < chain.spans(); ++k) {
    const double a = chain.breaks[At(k)], b = chain.breaks[At(k + 1)];
    for (int j = 1; j <= chain.degree; ++j)
      t.push_back(j == chain.degree ? b : a + (b - a) * j / chain.degree);
  }
  return t;
}

std::vector<double> ChainKnots(const BezierChain& chain) {
  std::vector<double> knots(At(chain.degree + 1), 0.0);
  for (int k = 1; k < chain.spans(); ++k) knots.insert(knots.end(), At(chain.degree), chain.breaks[At(k)]);
  knots.insert(knots.end(), At(chain.degree + 1), 1.0);
  return knots;
}

}  // namespace patchmill
