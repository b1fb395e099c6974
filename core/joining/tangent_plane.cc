#include "core/joining/tangent_plane.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/SVD>

namespace patchmill {
namespace {

// [joining (5)] at one end, where c is the true derivative of the edge.
std::variant<std::array<double, 3>, JoinFault> FactorsAt(const Vec3& c, const Vec3& a, const Vec3& b,
                                                         const Vec3& n) {
  const auto area = [&n](const Vec3& x, const Vec3& y) { return n.dot(x.cross(y)); };
  const double l = area(a, b), h = area(c, b), k = area(a, c);
  if (!(std::abs(h) > kMinTangentSine * c.norm() * b.norm() &&
        std::abs(k) > kMinTangentSine * c.norm() * a.norm())) {
    return JoinFault::kParallel;
  }
  const double scale = 2.0 / (h + k);
  if (!(std::isfinite(scale) && h * scale > kMinJoinFactor && k * scale > kMinJoinFactor))
    return JoinFault::kFolded;
  return std::array<double, 3>{l * scale, h * scale, k * scale};
}

// Bezier points of (1-u) f0 + u f1 times the curve of the points `p`: one degree more.
std::vector<Vec3> TimesLinear(const std::array<double, 2>& f, const std::vector<Vec3>& p) {
  const std::size_t n = p.size();
  std::vector<Vec3> product;
  for (std::size_t i = 0; i <= n; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(n);
    Vec3 q = Vec3::Zero();
    if (i < n) q += f[0] * (1.0 - share) * p[i];
    if (i > 0) q += f[1] * share * p[i - 1];
    product.push_back(q);
  }
  return product;
}

double Linear(const std::array<double, 2>& f, double u) {
  if (u == 0.0) return f[0];
  return u == 1.0 ? f[1] : (1.0 - u) * f[0] + u * f[1];
}

}  // namespace

std::variant<JoinFactors, JoinFault> FactorsAlong(const Vec3& start, const Vec3& end, const CrossTangents& t,
                                                  const Vec3& n0, const Vec3& n1) {
  JoinFactors factors;
  for (const int side : {0, 1}) {
    const auto at = side == 0 ? FactorsAt(start, t.a0, t.b0, n0) : FactorsAt(end, t.a1, t.b1, n1);
    if (const auto* fault = std::get_if<JoinFault>(&at)) return *fault;
    const auto& [l, h, k] = std::get<std::array<double, 3>>(at);
    const auto i = static_cast<std::size_t>(side);
    factors.l[i] = l;
    factors.h[i] = h;
    factors.k[i] = k;
  }
  return factors;
}

EdgeTwists WishedTwists(const CrossTangents& t) {
  return {t.a1 - t.a0, t.a0 - t.a1, t.b1 - t.b0, t.b0 - t.b1};
}

TwistConditions ConditionsFor(const HermiteCurve& edge, const CrossTangents& t, const JoinFactors& f) {
  const auto& [l0, l1] = f.l;
  const auto& [h0, h1] = f.h;
  const auto& [k0, k1] = f.k;
  const Vec3 d = edge.p1 - edge.p0, &c0 = edge.d0, &c1 = edge.d1;  // c1 = -(outgoing) of the paper
  TwistConditions conditions;
  conditions.matrix << h0, 0.0, k0, 0.0,  //
      h1, h0, k1, k0,                     //
      0.0, h1, 0.0, k1;
  conditions.right.row(0) =
      (-(h1 * t.a0 + k1 * t.b0) + 6.0 * l0 * d + (l1 - 4.0 * l0) * c0 - 2.0 * l0 * c1).transpose();
  conditions.right.row(1) = (-3.0 * (h1 * t.a0 + h0 * t.a1 + k1 * t.b0 + k0 * t.b1) + 6.0 * (l0 + l1) * d -
                             (2.0 * l0 + l1) * c0 - (l0 + 2.0 * l1) * c1)
                                .transpose();
  conditions.right.row(2) =
      (-(h0 * t.a1 + k0 * t.b1) + 6.0 * l1 * d + (l0 - 4.0 * l1) * c1 - 2.0 * l1 * c0).transpose();
  return conditions;
}

EdgeTwists NearestTwists(const HermiteCurve& edge, const CrossTangents& tangents, const JoinFactors& factors,
                         const EdgeTwists& wished) {
  const TwistConditions conditions = ConditionsFor(edge, tangents, factors);
  Eigen::Matrix<double, 4, 3> x;
  x.row(0) = wished.a0.transpose();
  x.row(1) = wished.a1.transpose();
  x.row(2) = wished.b0.transpose();
  x.row(3) = wished.b1.transpose();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(conditions.matrix, Eigen::ComputeThinU | Eigen::ComputeThinV);
  const Eigen::Matrix3d residual = conditions.right - conditions.matrix * x;
  for (int k = 0; k < 3; ++k) {
    const double sigma = svd.singularValues()[k];
    if (!(sigma > kPseudoInverseCutoff * svd.singularValues()[0])) continue;
    const Eigen::RowVector3d part = svd.matrixU().col(k).transpose() * residual / sigma;
    for (int row = 0; row < 4; ++row) x.row(row) = (x.row(row) + svd.matrixV()(row, k) * part).eval();
  }
  return {x.row(0).transpose(), x.row(1).transpose(), x.row(2).transpose(), x.row(3).transpose()};
}

BezierCurve CrossBoundaryTangent(const Vec3& at0, const Vec3& twist0, const Vec3& at1, const Vec3& twist1) {
  return {{at0, at0 + twist0 / 3.0, at1 + twist1 / 3.0, at1}};
}

BezierChain CorrectionFor(const BezierChain& edge, const JoinFactors& f) {
  const int n = edge.degree;
  const BezierChain cubic = CutAt(Elevated(AsChain(ToBezier(HermiteOf(edge))), n), edge.breaks);
  BezierChain correction{n, edge.breaks, std::vector<Vec3>(edge.points.size())};
  for (int k = 0; k < edge.spans(); ++k) {
    const auto span = static_cast<std::size_t>(k);
    const double from = edge.breaks[span], to = edge.breaks[span + 1];
    const std::size_t first = span * static_cast<std::size_t>(n);
    // Bezier points of (C - H)' / 2, degree n - 1. They are zero at both ends of the edge by construction.
    std::vector<Vec3> slope;
    for (std::size_t i = first; i < first + static_cast<std::size_t>(n); ++i) {
      slope.push_back(0.5 * n / (to - from) *
                      ((edge.points[i + 1] - cubic.points[i + 1]) - (edge.points[i] - cubic.points[i])));
    }
    if (k == 0) slope.front().setZero();
    if (k + 1 == edge.spans()) slope.back().setZero();
    const std::vector<Vec3> product = TimesLinear({Linear(f.l, from), Linear(f.l, to)}, slope);
    std::ranges::copy(product, correction.points.begin() + static_cast<std::ptrdiff_t>(first));
  }
  return correction;
}

BezierChain FollowingTangent(const BezierChain& given, const BezierChain& given_leading,
                             const JoinFactors& factors, const Vec3& b0, const Vec3& b1) {
  std::vector<BezierChain> both = {given, Elevated(given_leading, given.degree - 1)};
  const std::vector<double> breaks = CommonBreaks(both);
  const BezierChain edge = CutAt(both[0], breaks), leading = CutAt(both[1], breaks);
  const int n = edge.degree;
  const auto share = [&factors](const std::array<double, 2>& f) {
    return std::array{f[0] / factors.k[0], f[1] / factors.k[1]};
  };
  const auto l = share(factors.l), h = share(factors.h);
  BezierChain b{n, breaks, std::vector<Vec3>(edge.points.size())};
  for (int k = 0; k < edge.spans(); ++k) {
    const auto span = static_cast<std::size_t>(k);
    const double from = breaks[span], to = breaks[span + 1];
    const std::vector<Vec3> curve = SpanOf(edge, k).points;
    std::vector<Vec3> slope;
    for (std::size_t i = 0; i + 1 < curve.size(); ++i)
      slope.push_back(n / (to - from) * (curve[i + 1] - curve[i]));
    const std::vector<Vec3> along = TimesLinear({Linear(l, from), Linear(l, to)}, slope);
    const std::vector<Vec3> turned = TimesLinear({Linear(h, from), Linear(h, to)}, SpanOf(leading, k).points);
    for (std::size_t i = 0; i < along.size(); ++i) {
      b.points[span * static_cast<std::size_t>(n) + i] = along[i] - turned[i];
    }
  }
  b.points.front() = b0;
  b.points.back() = b1;
  return b;
}

}  // namespace patchmill
