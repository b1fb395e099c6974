// A curve through points as an elastic beam: a cubic over each chord, and one energy for the whole curve
// ([references: okada1969]; [fairing, section 1]).
//
// The paper's X_i is the derivative at the start of segment i in the segment's own parameter. Here it is
// C_i m_i, and the paper's end derivative k_{i+1} X_{i+1} is C_i m_{i+1}. The tangent m_i is the derivative
// with respect to the length of the chord polygon. A node has one tangent for both of its sides, so the last
// node is no exception. The length unit is that of the points.
#pragma once

#include <optional>
#include <vector>

#include "core/base/vec.h"

namespace patchmill {

struct Beam {
  std::vector<Vec3> points;    // P_i; at least 2, and neighbours do not coincide
  std::vector<double> chords;  // C_i = |P_{i+1} - P_i|, one fewer than points; the frozen chords of
                               // [fairing (5), (6)]
  std::vector<Vec3> tangents;  // m_i = X_i / C_i; length about 1

  int count() const { return static_cast<int>(points.size()); }
};

std::vector<double> Chords(const std::vector<Vec3>& points);

// Segment i in [0, count - 2] in its own parameter t in [0,1]: start + r1 t + r2 t^2 + r3 t^3
// [fairing (1), (2)].
struct BeamSegment {
  Vec3 start = Vec3::Zero(), r1 = Vec3::Zero(), r2 = Vec3::Zero(), r3 = Vec3::Zero();
  Vec3 Point(double t) const { return start + t * (r1 + t * (r2 + t * r3)); }
  Vec3 Derivative(double t) const { return r1 + t * (2.0 * r2 + 3.0 * t * r3); }
  Vec3 Second(double t) const { return 2.0 * r2 + 6.0 * t * r3; }
};
BeamSegment Segment(const Beam& beam, int i);

// The energy V: the integral of |P''|^2 over the length, where P'' is computed with the frozen chords
// [fairing (3)]. Unit: 1/length. The relative error is about 1e-14 of the largest term.
double Energy(const Beam& beam);

// Tangents at the ends, in the direction of increasing i [fairing, section 3]. The direction is the given one
// (any length but 0). Without one it is the direction of the circle through the three points at that end, or
// of the chord if these are in line or the third is the first again. The length is that of the derivative of
// the parabola through the three points in the chord parameter. With two points, the tangent is the unit
// chord.
struct EndTangents {
  Vec3 start, end;
};
EndTangents FitEndTangents(const std::vector<Vec3>& points, const std::vector<double>& chords,
                           const std::optional<Vec3>& start_direction,
                           const std::optional<Vec3>& end_direction);

// The equation of one node for the tangents [fairing (7)]:
// m_{i-1} + 2 (1 + k) m_i + k m_{i+1} = rhs with k = C_{i-1} / C_i. The derivative of the energy is
// dV/dX_i = 4 k (lhs - rhs) / C_{i-1}^2 [fairing (5)].
struct TangentRow {
  double k = 1.0;
  Vec3 rhs = Vec3::Zero();
};
TangentRow TangentRowOf(const Beam& beam, int i);  // 0 < i < count - 1

// The equation of one node for the points [fairing (8)]:
// 2 before (P_i - P_{i-1}) + 2 after (P_i - P_{i+1}) = rhs, where `before` and `after` are 1/C^3 of the two
// segments. The derivative of the energy is dV/dP_i = 12 (lhs - rhs) [fairing (6)]. The system of the free
// nodes is symmetric positive definite.
struct PositionRow {
  double before = 0.0, after = 0.0;
  Vec3 rhs = Vec3::Zero();
};
PositionRow PositionRowOf(const Beam& beam, int i);  // 0 < i < count - 1

// The curve of least energy through the points: the C2 cubic spline in the chord parameter with these end
// tangents [fairing (7)]. Cost O(n): one elimination. It needs no pivots, because each row is dominated by
// its diagonal.
Beam FitBeam(std::vector<Vec3> points, const std::optional<Vec3>& start_direction,
             const std::optional<Vec3>& end_direction);

// Curvature of the projections on the planes xy, yz and zx at each node, in 1/length [fairing (11)]. It is 0
// where the projected tangent vanishes (length below 1e-9).
std::vector<Vec3> ProjectedCurvatures(const Beam& beam);

// Points of the curve. Each segment is cut into N equal steps of the parameter, such that no chord is farther
// than `tolerance` > 0 from its arc: N = ceil(sqrt(max|P''| / (8 tolerance))). The nodes are among the
// points, bit by bit.
int PolylineSteps(const BeamSegment& segment, double tolerance);
std::vector<Vec3> Polyline(const Beam& beam, double tolerance);

// The number of points that Polyline returns. It is a double because it may exceed the range of int.
double PolylineSize(const Beam& beam, double tolerance);

}  // namespace patchmill
