// Parts of trimmed faces in closed form, for the tests of core/trim.
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

#include "core/base/index.h"
#include "core/brep/brep_model.h"

namespace patchmill::testing {

// A frame whose axes are parallel to none of the coordinate axes.
inline BrepFrame TiltedFrame() {
  const Eigen::Matrix3d m = Eigen::AngleAxisd(1.1, Vec3(3, -1, 2).normalized()).toRotationMatrix();
  return {{5, -3, 2}, m.col(0), m.col(1), m.col(2)};
}

inline BrepCurve StraightCurve(const Vec3& a, const Vec3& b) { return {1, {0, 0, 1, 1}, {a, b}, {}}; }

// `quarters` quarter turns from center + x towards center + y; x and y have the length of the radius.
inline BrepCurve ArcCurve(const Vec3& center, const Vec3& x, const Vec3& y, int quarters) {
  BrepCurve curve;
  curve.degree = 2;
  curve.knots = {0, 0, 0};
  for (int k = 0; k < quarters; ++k) {
    const double turn[5] = {1, 0, -1, 0, 1};
    const int i = k % 4;
    const Vec3 a = turn[i] * x + (i == 1 ? 1 : (i == 3 ? -1 : 0)) * y;
    const int n = (k + 1) % 4;
    const Vec3 b = turn[n] * x + (n == 1 ? 1 : (n == 3 ? -1 : 0)) * y;
    if (k == 0) {
      curve.points.push_back(center + a);
      curve.weights.push_back(1);
    }
    curve.points.push_back(center + a + b);
    curve.weights.push_back(std::sqrt(0.5));
    curve.points.push_back(center + b);
    curve.weights.push_back(1);
    const double knot = k + 1;
    curve.knots.insert(curve.knots.end(), {knot, knot});
  }
  curve.knots.push_back(quarters);
  return curve;
}

// The polynomial of the degree through a curve's points at Chebyshev places of [0,1]: the curve itself where
// it is such a polynomial, to about 1e-12 of its size.
inline BrepCurve PolynomialCurve(int degree, const std::function<Vec3(double)>& at) {
  const int n = degree + 1;
  Eigen::MatrixXd a(n, n);
  Eigen::MatrixXd b(n, 3);
  for (int k = 0; k < n; ++k) {
    const double t = 0.5 - 0.5 * std::cos(kPi * k / degree);
    double binomial = 1.0;
    for (int i = 0; i < n; ++i) {
      a(k, i) = binomial * std::pow(t, i) * std::pow(1 - t, degree - i);
      binomial = binomial * (degree - i) / (i + 1);
    }
    b.row(k) = at(t).transpose();
  }
  const Eigen::MatrixXd c = a.fullPivLu().solve(b);
  BrepCurve curve;
  curve.degree = degree;
  curve.knots.assign(At(n), 0.0);
  curve.knots.insert(curve.knots.end(), At(n), 1.0);
  for (int i = 0; i < n; ++i) curve.points.push_back(c.row(i).transpose());
  return curve;
}

class PartMaker {
 public:
  int Edge(BrepCurve curve) {
    part_.edges.push_back({std::move(curve)});
    return static_cast<int>(part_.edges.size()) - 1;
  }
  int Pole() {
    part_.edges.push_back({{}, true});
    return static_cast<int>(part_.edges.size()) - 1;
  }
  BrepFace& Face(BrepSurface surface, std::vector<BrepLoop> loops) {
    BrepFace face;
    face.surface = std::move(surface);
    face.loops = std::move(loops);
    part_.faces.push_back(std::move(face));
    return part_.faces.back();
  }
  BrepModel& part() { return part_; }

 private:
  BrepModel part_;
};

// `hint`: parameters of the surface at a parameter of the edge's curve.
inline BrepEdgeUse UseOf(int edge, bool forward, double first, double last,
                         const std::function<Vec2(double)>& hint) {
  BrepEdgeUse use;
  use.edge = edge;
  use.forward = forward;
  for (int k = 0; k <= 64; ++k) {
    use.hint_at.push_back(first + (last - first) * k / 64);
    use.hint.push_back(hint(use.hint_at.back()));
  }
  return use;
}
inline BrepEdgeUse StraightUse(int edge, bool forward, const Vec2& a, const Vec2& b) {
  return UseOf(edge, forward, 0, 1, [=](double t) { return Vec2(a + t * (b - a)); });
}

}  // namespace patchmill::testing
