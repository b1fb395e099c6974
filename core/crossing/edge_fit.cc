#include "core/crossing/edge_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>

#include "core/base/index.h"
#include "core/base/segment.h"
#include "core/math/bernstein.h"

namespace patchmill {
namespace {

constexpr int kTriangleDegree = 4, kQuadDegree = 7;
constexpr double kExact = 1e-9;  // share of the length, and rad

bool SecondDerivativeContinues(const BezierChain& chain) {
  for (int k = 1; k < chain.spans(); ++k) {
    const auto [before, after] = JetsAtBreak(chain, k);
    if ((before.d - after.d).norm() > 1e-9 * before.d.norm() ||
        (before.dd - after.dd).norm() > 1e-8 * (before.dd.norm() + before.d.norm())) {
      return false;
    }
  }
  return true;
}

// The part itself, with its ends on the vertices, if it may stay as it is.
std::optional<Curve> ItsOwnCurve(const GraphEdge& edge, const EdgeWish& wish) {
  if (edge.parts.size() != 1) return std::nullopt;
  BezierChain chain = edge.parts[0];
  const double length = (wish.end - wish.start).norm();
  if ((chain.points.front() - wish.start).norm() > kExact * length ||
      (chain.points.back() - wish.end).norm() > kExact * length) {
    return std::nullopt;
  }
  // A tangent that leaves its plane by rounding is laid into it.
  const Vec3 t0 = edge.Tangent(true), t1 = edge.Tangent(false);
  if (t0.cross(wish.start_direction).norm() > kExact || t0.dot(wish.start_direction) < 0 ||
      t1.cross(wish.end_direction).norm() > kExact || t1.dot(wish.end_direction) < 0) {
    return std::nullopt;
  }
  const int most = wish.beside_triangle ? kTriangleDegree : 11;
  if (chain.degree > most) return std::nullopt;
  if (chain.degree < 3) chain = Elevated(std::move(chain), 3);
  if (chain.spans() > 1 && (wish.beside_triangle || !SecondDerivativeContinues(chain))) return std::nullopt;
  const std::size_t n = chain.points.size();
  const double first = (chain.points[1] - chain.points[0]).norm();
  const double last = (chain.points[n - 2] - chain.points[n - 1]).norm();
  chain.points.front() = wish.start, chain.points.back() = wish.end;
  chain.points[1] = wish.start + first * wish.start_direction;
  chain.points[n - 2] = wish.end + last * wish.end_direction;
  if (chain.spans() == 1) return BezierCurve{chain.points};
  return BsplineCurve{chain.degree, ChainKnots(chain), chain.points};
}

double FarthestFrom(const BezierCurve& curve, const std::vector<Vec3>& samples) {
  constexpr int kSteps = 200;
  std::vector<Vec3> points;
  for (int k = 0; k <= kSteps; ++k) points.push_back(Evaluate(curve, k / double(kSteps)).p);
  double farthest = 0.0;
  std::size_t near = 1;
  for (const Vec3& p : samples) {
    double best = kInfinity;
    std::size_t at = near;
    for (std::size_t k = 1; k < points.size(); ++k) {
      const double d = SegmentDistance(p, points[k - 1], points[k]);
      if (d < best) best = d, at = k;
    }
    near = at;
    farthest = std::max(farthest, best);
  }
  return farthest;
}

// Least squares with fixed ends and end directions; lengths of the end tangents are free.
BezierCurve Fit(const std::vector<Vec3>& samples, const EdgeWish& wish, int degree) {
  std::vector<double> t = {0.0};
  for (std::size_t k = 1; k < samples.size(); ++k)
    t.push_back(t.back() + (samples[k] - samples[k - 1]).norm());
  const double length = t.back();
  for (double& x : t) x /= length;
  const int inner = degree - 3, unknowns = 2 + 3 * inner;
  BezierCurve curve;
  for (int round = 0; round < 8; ++round) {
    const auto rows = static_cast<Eigen::Index>(3 * samples.size());
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(rows + 2, unknowns);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(rows + 2);
    for (std::size_t k = 0; k < samples.size(); ++k) {
      double b[kMaxBasisDegree + 1];
      AllBernstein(degree, t[k], b);
      const Vec3 rest = samples[k] - (b[0] + b[1]) * wish.start - (b[degree] + b[degree - 1]) * wish.end;
      for (int x = 0; x < 3; ++x) {
        const auto row = static_cast<Eigen::Index>(3 * k) + x;
        right[row] = rest[x];
        a(row, 0) = b[1] * wish.start_direction[x];
        a(row, 1) = b[degree - 1] * wish.end_direction[x];
        for (int i = 0; i < inner; ++i) a(row, 2 + 3 * i + x) = b[i + 2];
      }
    }
    // A faint wish for tangents of a third of the length keeps straight curves determined.
    const double faint = 1e-6;
    a(rows, 0) = a(rows + 1, 1) = faint;
    right[rows] = right[rows + 1] = faint * length / degree;
    Eigen::VectorXd found = a.colPivHouseholderQr().solve(right);
    const double least = 0.15 * length / degree, most = 2.5 * length / degree;
    for (const int x : {0, 1}) {
      if (found[x] >= least && found[x] <= most) continue;
      const double fixed = std::clamp(found[x], least, most);
      right -= fixed * a.col(x);
      a.col(x).setZero();
      found = a.colPivHouseholderQr().solve(right);
      found[x] = fixed;
      if (x == 1 && found[0] < least) found[0] = least;
    }
    curve.points.assign(At(degree) + 1, Vec3::Zero());
    curve.points[0] = wish.start, curve.points[At(degree)] = wish.end;
    curve.points[1] = wish.start + std::clamp(found[0], least, most) * wish.start_direction;
    curve.points[At(degree - 1)] = wish.end + std::clamp(found[1], least, most) * wish.end_direction;
    for (int i = 0; i < inner; ++i) curve.points[At(i + 2)] = found.segment<3>(2 + 3 * i);
    // Each sample is then compared with its nearest place.
    for (std::size_t k = 1; k + 1 < samples.size(); ++k) {
      const CurveJet jet = Evaluate(curve, t[k]);
      const double h = jet.d.squaredNorm();
      if (h > 0) t[k] = std::clamp(t[k] - jet.d.dot(jet.p - samples[k]) / h, 0.0, 1.0);
    }
    std::ranges::sort(t);
  }
  return curve;
}

}  // namespace

FittedEdge FitGraphEdge(const GraphEdge& edge, const EdgeWish& wish) {
  if (std::optional<Curve> own = ItsOwnCurve(edge, wish)) return {*std::move(own), 0.0};
  int spans = 0;
  for (const BezierChain& part : edge.parts) spans += part.spans();
  const std::vector<Vec3> drawn = edge.Points(std::clamp(400 / spans, 4, 40));
  // Ends that have to meet others pull the curve along, less and less with the distance.
  std::vector<double> at = {0.0};
  for (std::size_t k = 1; k < drawn.size(); ++k) at.push_back(at.back() + (drawn[k] - drawn[k - 1]).norm());
  std::vector<Vec3> samples = drawn;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double share = at[k] / at.back();
    samples[k] += (1 - share) * (wish.start - drawn.front()) + share * (wish.end - drawn.back());
  }
  FittedEdge best;
  best.moved = kInfinity;
  const int most = wish.beside_triangle ? kTriangleDegree : kQuadDegree;
  for (int degree = 3; degree <= most && best.moved > 0.25 * wish.tolerance; ++degree) {
    const BezierCurve curve = Fit(samples, wish, degree);
    const double moved = FarthestFrom(curve, drawn);
    if (moved < best.moved) best = {curve, moved};
  }
  return best;
}

}  // namespace patchmill
