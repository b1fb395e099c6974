// Vectors and boxes. Lengths are millimetres everywhere inside Patchmill, angles radians.
#pragma once

#include <limits>
#include <numbers>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace patchmill {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Vec4 = Eigen::Vector4d;
using Mat3 = Eigen::Matrix3d;

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

inline constexpr double Radians(double degrees) { return degrees * (kPi / 180.0); }
inline constexpr double Degrees(double radians) { return radians * (180.0 / kPi); }

inline Vec2 Xy(const Vec3& p) { return {p.x(), p.y()}; }  // the view from above
inline Vec3 Lift(const Vec2& q, double z) { return {q.x(), q.y(), z}; }
inline double Cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

// Axis-parallel box, closed. A new box is empty (min > max) and grows by Add.
struct Box3 {
  Vec3 min = Vec3::Constant(kInfinity);
  Vec3 max = Vec3::Constant(-kInfinity);

  bool Empty() const { return !(min.x() <= max.x()); }
  void Add(const Vec3& p) {
    min = min.cwiseMin(p);
    max = max.cwiseMax(p);
  }
  void Add(const Box3& b) {
    min = min.cwiseMin(b.min);
    max = max.cwiseMax(b.max);
  }
  Vec3 Center() const { return 0.5 * (min + max); }
  double Diagonal() const { return Empty() ? 0.0 : (max - min).norm(); }
};

}  // namespace patchmill
