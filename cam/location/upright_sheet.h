// Walls that stand upright: a curve in plan, swept along z. A ball beside one touches it along a whole line,
// however far it is lifted; models in two parameters would be divided along that line without end. In plan it
// is one place of a curve.
#pragma once

#include <array>
#include <optional>

#include "core/surface/net_kernel.h"

namespace patchmill::internal {

// Homogeneous: (x w, y w, 0, w).
struct XyCurve {
  int degree = 0;
  std::array<Vec4, kMaxDegree + 1> points{};
  double spread = 0.0;  // mm: how far points of the sheet lie from the curve in plan at most
};

// The curve in plan of a net whose rows or columns are upright, to `rounding` (mm); nullopt for any other net
// or where a point has no weight.
std::optional<XyCurve> XyCurveOf(NetShape shape, const Vec4* points, double rounding);

// Is no point of the curve nearer to q than `radius` (mm)? True is proven: its distance form (core/surface)
// has no negative coefficient in any of the parts it is divided into (by halves, quadratic convergence: about
// 40 parts where a circle touches), beyond what rounding explains. False: some point is nearer, or nothing
// could be proven.
bool OutsideInXy(const XyCurve& curve, const Vec2& q, double radius);

}  // namespace patchmill::internal
