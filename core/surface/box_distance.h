// Distances of boxes to a point or to the upward ray {c + s e_z, s >= 0}. They are squared and exact up to
// rounding.
#pragma once

#include <algorithm>
#include <array>

#include "core/base/vec.h"
#include "core/surface/box_node.h"

namespace patchmill {

enum class Reach { kPoint, kUpwardRay };

// The vector from the set at the origin to p. For a point it is p itself; for the ray, a positive z becomes
// 0.
template <Reach kReach>
inline Vec3 FromSet(const Vec3& p) {
  return kReach == Reach::kUpwardRay && p.z() > 0.0 ? Vec3(p.x(), p.y(), 0.0) : p;
}

template <Reach kReach>
inline double SquaredDistance(const Box3& box, const Vec3& c) {
  const double x = std::max({box.min.x() - c.x(), c.x() - box.max.x(), 0.0});
  const double y = std::max({box.min.y() - c.y(), c.y() - box.max.y(), 0.0});
  const double above = kReach == Reach::kUpwardRay ? 0.0 : box.min.z() - c.z();
  const double z = std::max({above, c.z() - box.max.z(), 0.0});
  return x * x + y * y + z * z;
}

// The same for the four boxes of a node, in double lanes.
template <Reach kReach>
inline std::array<double, 4> SquaredDistances(const BoxNode& node, const Vec3& c) {
  using Lanes = double __attribute__((vector_size(16)));  // two lanes, which every processor has
  std::array<double, 4> squared;
  for (int half = 0; half < 2; ++half) {
    const auto lanes = [half](const Float4& four) {
      return Lanes{static_cast<double>(four[2 * half]), static_cast<double>(four[2 * half + 1])};
    };
    const auto max = [](const Lanes& a, const Lanes& b) { return a > b ? a : b; };
    const Lanes zero{};
    const Lanes x = max(max(lanes(node.min_x) - c.x(), c.x() - lanes(node.max_x)), zero);
    const Lanes y = max(max(lanes(node.min_y) - c.y(), c.y() - lanes(node.max_y)), zero);
    Lanes z = max(c.z() - lanes(node.max_z), zero);
    if (kReach == Reach::kPoint) z = max(z, lanes(node.min_z) - c.z());
    const Lanes sum = x * x + y * y + z * z;
    squared[static_cast<std::size_t>(2 * half)] = sum[0];
    squared[static_cast<std::size_t>(2 * half + 1)] = sum[1];
  }
  return squared;
}

// Distance of the point c to an oriented box, given by its center, orthonormal axes (columns) and half sides.
double SquaredDistanceToPoint(const Vec3& center, const Eigen::Matrix3d& axis, const Vec3& half,
                              const Vec3& c);
// The same for the upward ray from c: the minimum over s of a convex piecewise quadratic, found between its
// break points.
double SquaredDistanceToUpwardRay(const Vec3& center, const Eigen::Matrix3d& axis, const Vec3& half,
                                  const Vec3& c);

}  // namespace patchmill
