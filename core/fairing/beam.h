// A curve through points as an elastic beam: cubics over the chords, one energy ([references: okada1969];
// [fairing, section 1]).
//
// The paper's X_i, the derivative at the start of segment i in its own parameter, is C_i m_i here; its end
// derivative k_{i+1} X_{i+1} is C_i m_{i+1}. The tangents m_i are the derivatives in the length of the chord
// polygon, one vector at a node for both sides, so that the last node is no exception. Length unit as given.
#pragma once

#include <optional>
#include <vector>

#include "core/base/vec.h"

namespace patchmill {

struct Beam {
  std::vector<Vec3> points;    // P_i, at least 2, neighbours apart
  std::vector<double> chords;  // C_i = |P_{i+1} - P_i|, one fewer; the frozen ones of [fairing (5), (6)]
  std::vector<Vec3> tangents;  // m_i = X_i / C_i, about of length 1

  int count() const { return static_cast<int>(points.size()); }
};

std::vector<double> Chords(const std::vector<Vec3>& points);

// Segment i in [0, count - 2] over its own parameter t in [0,1]: start + r1 t + r2 t^2 + r3 t^3
// [fairing (1), (2)].
struct BeamSegment {
  Vec3 start = Vec3::Zero(), r1 = Vec3::Zero(), r2 = Vec3::Zero(), r3 = Vec3::Zero();
  Vec3 Point(double t) const { return start + t * (r1 + t * (r2 + t * r3)); }
  Vec3 Derivative(double t) const { return r1 + t * (2.0 * r2 + 3.0 * t * r3); }
  Vec3 Second(double t) const { return 2.0 * r2 + 6.0 * t * r3; }
};
BeamSegment Segment(const Beam& beam, int i);

// V: the integral of |P''|^2 over the length, curvature by the frozen chords [fairing (3)]. Unit 1/length.
// Relative error about 1e-14 of the largest term.
double Energy(const Beam& beam);

// Tangents at the ends, in the direction of increasing i [fairing, section 3]. Direction: as wished (any
// length but 0), else that of the circle through the last three points, the chord where they are in line or
// the third is the first again. Length: that of the parabola through the three in the chord parameter. Two
// points: the chord.
struct EndTangents {
  Vec3 start, end;
};
EndTangents FitEndTangents(const std::vector<Vec3>& points, const std::vector<double>& chords,
                           const std::optional<Vec3>& start_direction,
                           const std::optional<Vec3>& end_direction);

// One node's equation for the tangents [fairing (7)]:
// m_{i-1} + 2 (1 + k) m_i + k m_{i+1} = rhs, k = C_{i-1} / C_i; dV/dX_i = 4 k (lhs - rhs) / C_{i-1}^2
// [fairing (5)].
struct TangentRow {
  double k = 1.0;
  Vec3 rhs = Vec3::Zero();
};
TangentRow TangentRowOf(const Beam& beam, int i);  // 0 < i < count - 1

// One node's equation for the points [fairing (8)]:
// 2 before (P_i - P_{i-1}) + 2 after (P_i - P_{i+1}) = rhs; dV/dP_i = 12 (lhs - rhs) [fairing (6)]. Symmetric
// positive definite over the free nodes, as before and after are 1/C^3 of the two segments.
struct PositionRow {
  double before = 0.0, after = 0.0;
  Vec3 rhs = Vec3::Zero();
};
PositionRow PositionRowOf(const Beam& beam, int i);  // 0 < i < count - 1

// The curve of least energy through the points: the C2 cubic spline in the chord parameter with these end
// tangents [fairing (7)]. Cost O(n): one elimination without pivots, the rows are dominated by their
// diagonal.
Beam FitBeam(std::vector<Vec3> points, const std::optional<Vec3>& start_direction,
             const std::optional<Vec3>& end_direction);

// Curvature of the projection on the planes xy, yz and zx at each node, 1/length [fairing (11)]. 0 where the
// projected tangent vanishes (below 1e-9).
std::vector<Vec3> ProjectedCurvatures(const Beam& beam);

// Points of the curve, each segment cut into equal steps of the parameter so that no chord is farther than
// `tolerance` > 0 from its arc: N = ceil(sqrt(max|P''| / (8 tolerance))). The nodes are among them, bit by
// bit.
int PolylineSteps(const BeamSegment& segment, double tolerance);
std::vector<Vec3> Polyline(const Beam& beam, double tolerance);

// How many points Polyline gives; a double, for it may be absurd.
double PolylineSize(const Beam& beam, double tolerance);

}  // namespace patchmill
