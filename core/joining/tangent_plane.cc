#include "core/joining/tangent_plane.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/SVD>

namespace patchmill {
namespace {

// (6) at one end, c the true derivative of the edge.
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

BezierCurve CorrectionFor(const BezierCurve& edge, const JoinFactors& factors) {
  const int n = std::max(edge.degree(), 3);
  const BezierCurve whole = Elevated(edge, n), cubic = Elevated(ToBezier(HermiteOf(edge)), n);
  // Bezier points of (C - H)' / 2, degree n - 1; both ends vanish by construction.
  std::vector<Vec3> slope;
  for (std::size_t i = 0; i + 1 < whole.points.size(); ++i) {
    slope.push_back(0.5 * n *
                    ((whole.points[i + 1] - cubic.points[i + 1]) - (whole.points[i] - cubic.points[i])));
  }
  slope.front().setZero();
  slope.back().setZero();
  return {TimesLinear(factors.l, slope)};
}

BezierCurve FollowingTangent(const BezierCurve& edge, const BezierCurve& leading, const JoinFactors& factors,
                             const Vec3& b0, const Vec3& b1) {
  const int n = edge.degree();
  std::vector<Vec3> slope;
  for (std::size_t i = 0; i + 1 < edge.points.size(); ++i) {
    slope.push_back(n * (edge.points[i + 1] - edge.points[i]));
  }
  const auto share = [&factors](const std::array<double, 2>& f) {
    return std::array{f[0] / factors.k[0], f[1] / factors.k[1]};
  };
  BezierCurve b{TimesLinear(share(factors.l), slope)};
  const BezierCurve turned = Elevated({TimesLinear(share(factors.h), leading.points)}, n);
  for (std::size_t i = 0; i < b.points.size(); ++i) b.points[i] -= turned.points[i];
  b.points.front() = b0;
  b.points.back() = b1;
  return b;
}

}  // namespace patchmill
