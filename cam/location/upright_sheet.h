// Vertical walls, each a curve in plan that is swept along z. A ball beside such a wall touches it along a
// whole line, however far it is lifted. Models in two parameters would be divided along that line without
// end. In plan the line is one point of a curve.
#pragma once

#include <array>
#include <optional>

#include "core/surface/net_kernel.h"

namespace patchmill::internal {

// Homogeneous points (x w, y w, 0, w).
struct XyCurve {
  int degree = 0;
  std::array<Vec4, kMaxDegree + 1> points{};
  double spread = 0.0;  // mm, largest distance in plan of a point of the sheet from the curve
};

// The curve in plan of a net whose rows or columns are vertical, to `rounding` (mm). nullopt for any other
// net, or if a point has no weight.
std::optional<XyCurve> XyCurveOf(NetShape shape, const Vec4* points, double rounding);

// True is proven: no point of the curve is nearer to q than `radius` (mm). The distance form of the curve
// (core/surface) is divided into halves, and no coefficient of any part is negative by more than rounding.
// (Convergence is quadratic; about 40 parts where a circle touches.) False: some point is nearer, or nothing
// could be proven.
bool OutsideInXy(const XyCurve& curve, const Vec2& q, double radius);

}  // namespace patchmill::internal
