#include "core/surface/net_kernel.h"

#include <algorithm>
#include <cmath>

namespace patchmill {
namespace {

// Halves one line of a net: `n + 1` points, `stride` apart.
void HalveLine(int n, int stride, Vec4* low, Vec4* high) {
  // `high` holds the line and becomes the upper half in place. Its first point runs through the lower half.
  low[0] = high[0];
  for (int k = 1; k <= n; ++k) {
    for (int i = 0; i <= n - k; ++i) high[i * stride] = 0.5 * (high[i * stride] + high[(i + 1) * stride]);
    low[k * stride] = high[0];
  }
}

void RestrictLine(int n, int stride, Vec4* p, double t0, double t1) {
  if (t1 < 1.0) {  // keeps [0, t1]
    for (int k = 1; k <= n; ++k) {
      for (int i = n; i >= k; --i) p[i * stride] = (1.0 - t1) * p[(i - 1) * stride] + t1 * p[i * stride];
    }
  }
  if (t0 > 0.0) {  // keeps [t0 / t1, 1] of that
    const double t = t0 / t1;
    for (int k = 1; k <= n; ++k) {
      for (int i = 0; i <= n - k; ++i) p[i * stride] = (1.0 - t) * p[i * stride] + t * p[(i + 1) * stride];
    }
  }
}

// A right-handed frame for points whose two families of lines span no surface. The first axis is the longest
// direction, the second points to the point farthest from that line.
Eigen::Matrix3d FrameOfPoints(const Vec3* hull, int count) {
  const auto farthest = [&](const auto& part) {
    Vec3 best = Vec3::Zero();
    for (int i = 1; i < count; ++i) {
      const Vec3 d = part(Vec3(hull[i] - hull[0]));
      if (d.squaredNorm() > best.squaredNorm()) best = d;
    }
    return best;
  };
  const Vec3 along = farthest([](const Vec3& d) { return d; });
  if (!(along.norm() > 0.0)) return Eigen::Matrix3d::Identity();
  Eigen::Matrix3d axis;
  const Vec3 a = along.normalized();
  const Vec3 across = farthest([&](const Vec3& d) { return Vec3(d - d.dot(a) * a); });
  axis.col(0) = a;
  axis.col(1) =
      across.norm() > 1e-9 * along.norm() ? (across - across.dot(a) * a).normalized() : a.unitOrthogonal();
  axis.col(2) = axis.col(0).cross(axis.col(1)).normalized();
  return axis;
}

Eigen::Matrix3d FrameOfTangents(const Vec3& along_u, const Vec3& along_v, const Vec3* hull, int count) {
  const Vec3 normal = along_u.cross(along_v);
  // The two directions are less than 1e-6 rad apart: their cross product has no digits to trust.
  if (!(normal.norm() > 1e-6 * along_u.norm() * along_v.norm())) return FrameOfPoints(hull, count);
  Eigen::Matrix3d axis;
  axis.col(2) = normal.normalized();
  const Vec3& along = along_u.squaredNorm() >= along_v.squaredNorm() ? along_u : along_v;
  axis.col(0) = (along - along.dot(axis.col(2)) * axis.col(2)).normalized();
  axis.col(1) = axis.col(2).cross(axis.col(0)).normalized();
  return axis;
}

// Sum over the lines of one family of (last point - first point). Points without weight are left out.
Vec3 SumOfChords(int lines, int line_stride, int n, int stride, const Vec4* points) {
  Vec3 sum = Vec3::Zero();
  for (int l = 0; l < lines; ++l) {
    const Vec4* p = points + l * line_stride;
    int first = 0, last = n;
    while (first < n && !(p[first * stride].w() > 0.0)) ++first;
    while (last > first && !(p[last * stride].w() > 0.0)) --last;
    if (first == last) continue;
    sum += p[last * stride].head<3>() / p[last * stride].w() -
           p[first * stride].head<3>() / p[first * stride].w();
  }
  return sum;
}

struct LineBend {
  double normal = 0.0, length = 0.0, curl = 0.0;
};

// How the rows or the columns of a net lie in memory: lines of degree n, whose points are `stride` apart.
struct NetLines {
  int lines, line_stride, n, stride;
};

LineBend MeasureLines(const NetLines& net, const Vec4* points, const Vec3& normal, double tiny) {
  const auto& [lines, line_stride, n, stride] = net;
  LineBend bend;
  for (int l = 0; l < lines; ++l) {
    std::array<Vec3, kMaxDegree + 1> q;
    int count = 0;
    for (int i = 0; i <= n; ++i) {
      const Vec4& p = points[l * line_stride + i * stride];
      if (p.w() > 0.0) q[static_cast<std::size_t>(count++)] = p.head<3>() / p.w();
    }
    double length = 0.0;
    for (int i = 1; i < count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      length += (q[k] - q[k - 1]).norm();
      if (i + 1 < count) {
        const double second = std::abs((q[k - 1] - 2.0 * q[k] + q[k + 1]).dot(normal));
        bend.normal = std::max(bend.normal, 0.125 * n * (n - 1) * second);
      }
    }
    bend.length = std::max(bend.length, length);
    if (count > 1 && length > tiny) {
      const double chord = (q[static_cast<std::size_t>(count - 1)] - q[0]).norm();
      bend.curl = std::max(bend.curl, 1.0 - chord / length);
    }
  }
  return bend;
}

}  // namespace

void HalveNet(NetShape shape, const Vec4* points, bool along_u, Vec4* low, Vec4* high) {
  std::copy_n(points, shape.count(), high);
  const int row = shape.degree_v + 1;
  if (along_u) {
    for (int j = 0; j <= shape.degree_v; ++j) HalveLine(shape.degree_u, row, low + j, high + j);
  } else {
    for (int i = 0; i <= shape.degree_u; ++i) HalveLine(shape.degree_v, 1, low + i * row, high + i * row);
  }
}

void RestrictNet(NetShape shape, Vec4* points, const ParameterBox& part) {
  const double u0 = part.u0, u1 = part.u1, v0 = part.v0, v1 = part.v1;
  const int row = shape.degree_v + 1;
  if (u0 > 0.0 || u1 < 1.0) {
    for (int j = 0; j <= shape.degree_v; ++j) RestrictLine(shape.degree_u, row, points + j, u0, u1);
  }
  if (v0 > 0.0 || v1 < 1.0) {
    for (int i = 0; i <= shape.degree_u; ++i) RestrictLine(shape.degree_v, 1, points + i * row, v0, v1);
  }
}

int HullPoints(NetShape shape, const Vec4* points, Vec3* hull) {
  int count = 0;
  for (int i = 0; i < shape.count(); ++i) {
    if (points[i].w() > 0.0) hull[count++] = points[i].head<3>() / points[i].w();
  }
  return count;
}

RectBounds BoundInFrame(const Eigen::Matrix3d& axis, const Vec3* hull, int hull_count) {
  RectBounds bounds;
  bounds.axis = axis;
  Box3 oriented;  // relative to the first point: no digits are lost far from the origin
  for (int i = 0; i < hull_count; ++i) {
    bounds.box.Add(hull[i]);
    const Vec3 d = hull[i] - hull[0];
    oriented.Add(Vec3(bounds.axis.col(0).dot(d), bounds.axis.col(1).dot(d), bounds.axis.col(2).dot(d)));
  }
  bounds.center = hull[0] + bounds.axis * oriented.Center();
  const double coordinate =
      std::max(bounds.box.min.cwiseAbs().maxCoeff(), bounds.box.max.cwiseAbs().maxCoeff());
  const double rounding = 16.0 * std::numeric_limits<double>::epsilon() * coordinate;
  bounds.half = 0.5 * (oriented.max - oriented.min) + Vec3::Constant(rounding);
  return bounds;
}

RectBounds BoundPoints(NetShape shape, const Vec4* points, const Vec3* hull, int hull_count) {
  const int row = shape.degree_v + 1;
  const Vec3 along_u = SumOfChords(row, 1, shape.degree_u, row, points);
  const Vec3 along_v = SumOfChords(shape.degree_u + 1, row, shape.degree_v, 1, points);
  return BoundInFrame(FrameOfTangents(along_u, along_v, hull, hull_count), hull, hull_count);
}

RectBounds BoundNet(const BernsteinNet& net) {
  std::array<Vec3, kMaxNetPoints> hull;
  const NetShape shape{net.degree_u, net.degree_v};
  return BoundPoints(shape, net.points.data(), hull.data(),
                     HullPoints(shape, net.points.data(), hull.data()));
}

NetBend MeasureBend(NetShape shape, const Vec4* points, const Vec3& normal, double tiny) {
  const int row = shape.degree_v + 1;
  const LineBend u = MeasureLines({row, 1, shape.degree_u, row}, points, normal, tiny);
  const LineBend v = MeasureLines({shape.degree_u + 1, row, shape.degree_v, 1}, points, normal, tiny);
  return {u.normal, v.normal, u.length, v.length, u.curl, v.curl};
}

}  // namespace patchmill
