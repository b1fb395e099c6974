// Bernstein nets as plain arrays. The bounds hierarchy and the closest-point search subdivide them without
// touching the heap.
//
// A net of degrees (du, dv) is (du+1)(dv+1) homogeneous points, v fastest, as in BernsteinNet.
#pragma once

#include <array>

#include "core/surface/surface.h"

namespace patchmill {

struct NetShape {
  int degree_u = 0, degree_v = 0;
  int count() const { return (degree_u + 1) * (degree_v + 1); }
};

inline constexpr int kMaxNetPoints = (kMaxDegree + 1) * (kMaxDegree + 1);

// The halves [0,1/2] and [1/2,1] of a net along u or v. `low`, `high` and `points` do not overlap.
void HalveNet(NetShape shape, const Vec4* points, bool along_u, Vec4* low, Vec4* high);

// Replaces a net by its part.
void RestrictNet(NetShape shape, Vec4* points, const ParameterBox& part);

// Writes the Cartesian points of the net to `hull` and returns their number. Points without weight
// ([location T10]) are left out.
int HullPoints(NetShape shape, const Vec4* points, Vec3* hull);

// Bounds of at least one point, in a given frame.
RectBounds BoundInFrame(const Eigen::Matrix3d& axis, const Vec3* hull, int hull_count);

// Bounds of a net. `hull` and `hull_count` as from HullPoints.
RectBounds BoundPoints(NetShape shape, const Vec4* points, const Vec3* hull, int hull_count);

// How much a net bends; used to choose where to cut it. `normal` is the largest |second difference . normal|
// of the Cartesian net along u and v, scaled to a bound of the distance from a chord. `length` is the length
// of the longest row. `curl` is the share by which a row exceeds its chord.
struct NetBend {
  double normal_u = 0.0, normal_v = 0.0;  // mm
  double length_u = 0.0, length_v = 0.0;  // mm
  double curl_u = 0.0, curl_v = 0.0;      // 1 - chord / length of the most curled row longer than `tiny`
};
NetBend MeasureBend(NetShape shape, const Vec4* points, const Vec3& normal, double tiny);

}  // namespace patchmill
