#include "core/fairing/beam.h"

#include <algorithm>
#include <cmath>

#include "core/base/index.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

constexpr double kCollinear = 1e-12;        // sine of the angle below which three points are in line
constexpr double kVanishingTangent = 1e-9;  // of a projection; the tangents themselves have a length of about
                                            // 1

// The tangent at p1 of the circle through p1, p2 and p3, by inversion at p1.
Vec3 CircleDirection(const Vec3& p1, const Vec3& p2, const Vec3& p3) {
  const Vec3 d1 = p2 - p1, d2 = p3 - p1;
  const double sine = d1.cross(d2).norm(), size = d1.norm() * d2.norm();
  if (!(sine >= kCollinear * size) || size == 0.0) return d1.normalized();
  return (d1 / d1.squaredNorm() - d2 / d2.squaredNorm()).normalized();
}

// The length, at p1, of the derivative of the parabola through three points in the chord parameter.
double ParabolaSpeed(const Vec3& p1, const Vec3& p2, const Vec3& p3, double c1, double c2) {
  const double k = c1 / c2;
  return (((1.0 + 2.0 * k) * (p2 - p1) - k * k * (p3 - p2)) / (1.0 + k)).norm() / c1;
}

double SecondDerivativeBound(const BeamSegment& segment) {
  return std::max(segment.Second(0.0).norm(), segment.Second(1.0).norm());  // linear in t
}

double StepsNeeded(const BeamSegment& segment, double tolerance) {
  return std::max(1.0, std::ceil(std::sqrt(SecondDerivativeBound(segment) / (8.0 * tolerance))));
}

}  // namespace

std::vector<double> Chords(const std::vector<Vec3>& points) {
  std::vector<double> chords(points.size() - 1);
  for (std::size_t i = 0; i < chords.size(); ++i) chords[i] = (points[i + 1] - points[i]).norm();
  return chords;
}

BeamSegment Segment(const Beam& beam, int i) {
  const double c = beam.chords[At(i)];
  const Vec3 chord = beam.points[At(i + 1)] - beam.points[At(i)];
  const Vec3 d0 = c * beam.tangents[At(i)], d1 = c * beam.tangents[At(i + 1)];
  return {beam.points[At(i)], d0, 3.0 * chord - 2.0 * d0 - d1, d0 + d1 - 2.0 * chord};
}

double Energy(const Beam& beam) {
  double energy = 0.0;
  for (int i = 0; i + 1 < beam.count(); ++i) {
    const BeamSegment s = Segment(beam, i);
    const double c = beam.chords[At(i)];
    energy += 4.0 / (c * c * c) * (s.r2.dot(s.r2) + 3.0 * s.r2.dot(s.r3) + 3.0 * s.r3.dot(s.r3));
  }
  return energy;
}

EndTangents FitEndTangents(const std::vector<Vec3>& points, const std::vector<double>& chords,
                           const std::optional<Vec3>& start_direction,
                           const std::optional<Vec3>& end_direction) {
  const std::size_t n = points.size();
  const Vec3 chord = (points[n - 1] - points[n - 2]).normalized();
  EndTangents ends{(points[1] - points[0]).normalized(), chord};
  double start_speed = 1.0, end_speed = 1.0;
  if (n > 2) {
    ends.start = CircleDirection(points[0], points[1], points[2]);
    ends.end = -CircleDirection(points[n - 1], points[n - 2], points[n - 3]);
    start_speed = ParabolaSpeed(points[0], points[1], points[2], chords[0], chords[1]);
    end_speed = ParabolaSpeed(points[n - 1], points[n - 2], points[n - 3], chords[n - 2], chords[n - 3]);
  }
  if (start_direction) ends.start = start_direction->normalized();
  if (end_direction) ends.end = end_direction->normalized();
  return {start_speed * ends.start, end_speed * ends.end};
}

TangentRow TangentRowOf(const Beam& beam, int i) {
  const double before = beam.chords[At(i - 1)], after = beam.chords[At(i)];
  const Vec3 &p = beam.points[At(i)], &last = beam.points[At(i - 1)], &next = beam.points[At(i + 1)];
  const double k = before / after;
  return {k, 3.0 * ((p - last) / before + k / after * (next - p))};
}

PositionRow PositionRowOf(const Beam& beam, int i) {
  const double before = beam.chords[At(i - 1)], after = beam.chords[At(i)];
  const std::vector<Vec3>& m = beam.tangents;
  return {1.0 / (before * before * before), 1.0 / (after * after * after),
          (m[At(i - 1)] + m[At(i)]) / (before * before) - (m[At(i)] + m[At(i + 1)]) / (after * after)};
}

Beam FitBeam(std::vector<Vec3> points, const std::optional<Vec3>& start_direction,
             const std::optional<Vec3>& end_direction) {
  PM_CHECK(points.size() >= 2);
  Beam beam;
  beam.points = std::move(points);
  beam.chords = Chords(beam.points);
  const EndTangents ends = FitEndTangents(beam.points, beam.chords, start_direction, end_direction);
  const int n = beam.count();
  std::vector<Vec3>& m = beam.tangents;
  m.assign(beam.points.size(), ends.start);
  m.back() = ends.end;
  std::vector<double> upper(beam.points.size(), 0.0);
  for (int i = 1; i + 1 < n; ++i) {
    const TangentRow row = TangentRowOf(beam, i);
    const double pivot = 2.0 * (1.0 + row.k) - upper[At(i - 1)];
    upper[At(i)] = row.k / pivot;
    m[At(i)] = (row.rhs - m[At(i - 1)]) / pivot;
  }
  for (int i = n - 2; i > 0; --i) m[At(i)] -= upper[At(i)] * m[At(i + 1)];
  return beam;
}

std::vector<Vec3> ProjectedCurvatures(const Beam& beam) {
  std::vector<Vec3> curvatures(beam.points.size());
  for (int i = 0; i < beam.count(); ++i) {
    const int s = std::min(i, beam.count() - 2);
    const double c = beam.chords[At(s)];
    const double t = i == s ? 0.0 : 1.0;
    const BeamSegment segment = Segment(beam, s);
    const Vec3 d = segment.Derivative(t) / c, dd = segment.Second(t) / (c * c);
    for (int plane = 0; plane < 3; ++plane) {
      const int a = plane, b = (plane + 1) % 3;
      const double speed = std::hypot(d[a], d[b]);
      curvatures[At(i)][plane] =
          speed < kVanishingTangent ? 0.0 : (d[a] * dd[b] - d[b] * dd[a]) / (speed * speed * speed);
    }
  }
  return curvatures;
}

int PolylineSteps(const BeamSegment& segment, double tolerance) {
  return static_cast<int>(std::min(StepsNeeded(segment, tolerance), 1e9));
}

double PolylineSize(const Beam& beam, double tolerance) {
  double size = 1.0;
  for (int i = 0; i + 1 < beam.count(); ++i) size += StepsNeeded(Segment(beam, i), tolerance);
  return size;
}

std::vector<Vec3> Polyline(const Beam& beam, double tolerance) {
  std::vector<Vec3> line{beam.points.front()};
  for (int i = 0; i + 1 < beam.count(); ++i) {
    const BeamSegment segment = Segment(beam, i);
    const int steps = PolylineSteps(segment, tolerance);
    for (int k = 1; k < steps; ++k) line.push_back(segment.Point(static_cast<double>(k) / steps));
    line.push_back(beam.points[At(i + 1)]);
  }
  return line;
}

}  // namespace patchmill
