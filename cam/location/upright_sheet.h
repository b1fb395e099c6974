// Vertical walls: what of them decides, and proofs that balls are free of them. A vertical wall is a curve in
// plan that is swept along z. A ball beside such a wall touches it with its shank along a vertical line,
// however far the ball is lifted. A proof that divides the wall in both parameters would divide it along that
// line without end. In plan the line is one point of a curve, so here the proof is made for the curve.
//
// A ball is swept upwards for every question of this folder, so of the points of a vertical line the highest
// is the nearest: where z rises along the lines of a wall, its upper edge decides alone.
#pragma once

#include <array>
#include <optional>

#include "core/surface/net_kernel.h"

namespace patchmill::internal {

// Homogeneous points (x w, y w, 0, w).
struct XyCurve {
  int degree = 0;
  std::array<Vec4, kMaxDegree + 1> points{};
  double spread = 0.0;  // mm: no point of the wall is farther from the curve in plan
};

// Returns the curve in plan of a net whose rows (or whose columns) are vertical lines to within `rounding`
// (mm). nullopt for any other net, or if a control point has no weight.
std::optional<XyCurve> XyCurveOf(NetShape shape, const Vec4* points, double rounding);

// The direction in which the rows of a net are vertical lines.
enum class Upright { kNo, kAlongU, kAlongV };

// kAlongU (kAlongV) if all lines of constant v (u) are vertical to within `rounding` (mm) and z rises along
// all of them, or falls along all of them.
Upright UprightLinesOf(NetShape shape, const Vec4* points, double rounding);

// Returns true if it proves that no point of the curve is nearer to q than `radius` (mm). False: some point
// is nearer, or the proof failed. The proof halves the distance form of the curve
// (core/surface/distance_form.h) until no coefficient of any part is negative by more than rounding.
// Convergence is quadratic; a circle that touches the curve takes about 40 parts.
bool OutsideInXy(const XyCurve& curve, const Vec2& q, double radius);

}  // namespace patchmill::internal
