// The spline part of shapes.h.
#include <cmath>

#include <Eigen/LU>

#include "core/math/bspline_basis.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill::testing {
namespace {

// Clamped uniform cubic knots on [0, spans].
std::vector<double> CubicKnots(int spans) {
  std::vector<double> knots(3, 0.0);
  for (int k = 0; k <= spans; ++k) knots.push_back(k);
  knots.insert(knots.end(), 3, spans);
  return knots;
}

// Control values -> values at the knots 0..spans, then the two not-a-knot conditions (equal third derivatives
// left and right of the first and of the last inner knot).
Eigen::MatrixXd Collocation(int spans) {
  const std::vector<double> knots = CubicKnots(spans);
  const int count = spans + 3;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(count, count);
  BasisJet basis;
  for (int k = 0; k <= spans; ++k) {
    const int span = FindSpan(knots, 3, k);
    BsplineBasisJet(knots, 3, span, k, basis);
    for (int i = 0; i <= 3; ++i) a(k, span - 3 + i) = basis.f[i];
  }
  // The second derivative is linear in each span of length 1: its slope is the third derivative.
  const auto add_slope = [&](int row, int span, double sign) {
    BasisJet lo, hi;
    BsplineBasisJet(knots, 3, span, knots[span], lo);
    BsplineBasisJet(knots, 3, span, knots[span + 1], hi);
    for (int i = 0; i <= 3; ++i) a(row, span - 3 + i) += sign * (hi.dd[i] - lo.dd[i]);
  };
  add_slope(spans + 1, 3, 1.0);
  add_slope(spans + 1, 4, -1.0);
  add_slope(spans + 2, spans + 1, 1.0);
  add_slope(spans + 2, spans + 2, -1.0);
  return a;
}

double Greville(const std::vector<double>& knots, int i) {
  return (knots[i + 1] + knots[i + 2] + knots[i + 3]) / 3.0;
}

}  // namespace

BsplinePatch InterpolatedHeights(const HeightFunction& f, double x0, double x1, double y0, double y1,
                                 int spans_x, int spans_y) {
  BsplinePatch patch;
  patch.degree_u = patch.degree_v = 3;
  patch.knots_u = CubicKnots(spans_x);
  patch.knots_v = CubicKnots(spans_y);
  Eigen::MatrixXd heights = Eigen::MatrixXd::Zero(spans_x + 3, spans_y + 3);  // zero: the end conditions
  for (int i = 0; i <= spans_x; ++i) {
    for (int j = 0; j <= spans_y; ++j) {
      heights(i, j) = f(x0 + (x1 - x0) * i / spans_x, y0 + (y1 - y0) * j / spans_y);
    }
  }
  const Eigen::MatrixXd along_x = Collocation(spans_x).partialPivLu().solve(heights);
  const Eigen::MatrixXd z = Collocation(spans_y).partialPivLu().solve(along_x.transpose()).transpose();
  for (int i = 0; i < spans_x + 3; ++i) {
    for (int j = 0; j < spans_y + 3; ++j) {
      patch.points.emplace_back(x0 + (x1 - x0) * Greville(patch.knots_u, i) / spans_x,
                                y0 + (y1 - y0) * Greville(patch.knots_v, j) / spans_y, z(i, j));
    }
  }
  return patch;
}

double TwoHillsHeight(double x, double y) {
  const auto hill = [&](double height, double cx, double cy, double width) {
    return height * std::exp(-((x - cx) * (x - cx) + (y - cy) * (y - cy)) / width);
  };
  return hill(12, 30, 35, 300) + hill(18, 68, 60, 420) - hill(8, 70, 22, 250) + 8.0;
}

double BumpyHeight(double x, double y) {
  return 6.0 * std::sin(0.21 * x) * std::cos(0.17 * y) + 3.0 * std::sin(0.45 * x + 0.3 * y) +
         1.2 * std::cos(0.8 * y - 0.2 * x);
}

PatchModel TwoHills() { return Single(InterpolatedHeights(TwoHillsHeight, 0, 100, 0, 100, 32, 32)); }
PatchModel Bumpy() { return Single(InterpolatedHeights(BumpyHeight, 0, 100, 0, 100, 50, 50)); }

PatchModel RandomBspline(std::uint64_t seed, const RandomBsplineParams& params) {
  Random random(seed);
  BsplinePatch patch;
  patch.degree_u = patch.degree_v = 3;
  patch.knots_u = patch.knots_v = CubicKnots(params.spans);
  const double step = params.size / params.spans;
  for (int i = 0; i < params.spans + 3; ++i) {
    for (int j = 0; j < params.spans + 3; ++j) {
      Vec3 p(step * Greville(patch.knots_u, i), step * Greville(patch.knots_v, j),
             random.Uniform(-params.amplitude, params.amplitude));
      if (params.folds) {
        p.x() += random.Uniform(-1.5, 1.5) * step;
        p.y() += random.Uniform(-1.5, 1.5) * step;
      }
      patch.points.push_back(p);
      if (params.rational) patch.weights.push_back(random.Uniform(0.5, 2.0));
    }
  }
  return Single(std::move(patch));
}

}  // namespace patchmill::testing
