// A leaf of the search tree in 116 bytes. It holds everything that a query needs, rounded; the bounds include
// each rounding.
//
// Bounds (half sides, errors) are rounded up to 8 bits of mantissa, so they are never below what was proven.
// Everything else (place, model vectors, frame of the box) is rounded to the nearest number that can be
// stored. Box and errors are those of the stored numbers, not of the numbers before rounding. So a leaf never
// claims too much. Its proofs only succeed less often, by less than 1 % of its error terms.
#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "cam/location/leaf_model.h"
#include "cam/location/ray_distance.h"

namespace patchmill::internal {

// A bound that is never negative: the upper half of a float without its sign, rounded up. It is at most 0.4 %
// above the given number (2^-126 for zero). Infinity stays.
class UpperBound {
 public:
  UpperBound() = default;
  explicit UpperBound(double x);
  float value() const { return std::bit_cast<float>(static_cast<std::uint32_t>(bits_) << 15); }
  UpperBound Next() const;  // the next larger bound

 private:
  std::uint16_t bits_ = 0;
};

// The grid of the leaves' places: integer multiples of `step` from `origin`.
struct LeafGrid {
  Vec3 origin = Vec3::Zero();
  double step = 0.0;  // mm, size of the model / 2^32

  explicit LeafGrid(const Box3& box);
};

// An oriented box as in RectBounds, but its axes may point either way.
struct LeafBox {
  Vec3 center;
  Eigen::Matrix3d axis;
  Vec3 half;
};

// The points in whose convex hull a leaf lies, and the frame of its box. It refers to both.
struct FramedHull {
  const Eigen::Matrix3d& axis;
  std::span<const Vec3> points;
};

class SearchLeaf {
 public:
  // `model` and `hull` belong to the dyadic part `rect` of a piece.
  SearchLeaf(const LeafGrid& grid, std::int32_t piece, const Rect& rect, const LeafModel& model,
             const FramedHull& hull);

  static constexpr double kShiftUnit = 1.0 / 32768.0;  // in half sides

  std::int32_t piece() const { return piece_; }
  Rect rect() const {
    const Side u = SideOf(u_), v = SideOf(v_);
    return {u.low, u.high, v.low, v.high};
  }
  LeafBox Box(const LeafGrid& grid) const;
  // As OrientedBoxOutside for that box.
  bool Outside(const LeafGrid& grid, const Vec3& c, double limit2) const;
  LeafModel Model(const LeafGrid& grid) const;

 private:
  // A dyadic interval of [0, 1], coded as 2^level + index.
  struct Side {
    double low, high;
  };
  static Side SideOf(std::uint32_t code) {
    const auto level = static_cast<std::uint64_t>(std::bit_width(code) - 1);
    const double width = std::bit_cast<double>((1023 - level) << 52);  // 2^-level
    return {code * width - 1.0, (code + 1.0) * width - 1.0};
  }
  Vec3 Place(const LeafGrid& grid) const {
    return grid.origin + grid.step * Vec3(place_[0], place_[1], place_[2]);
  }
  Eigen::Matrix3d Axis() const;
  void RoundModel(const LeafGrid& grid, const LeafModel& m);
  void RoundBox(const LeafGrid& grid, const FramedHull& hull);

  std::int32_t piece_;
  std::uint32_t u_, v_;
  std::int32_t place_[3];  // s of the model
  float first_[6];         // a, b
  float second_unit_;      // for uu, uv, vv
  std::int16_t second_[9];
  std::int16_t shift_[3];  // of the box's centre from s along its axes, in half sides times kShiftUnit
  float turn_[3];          // the box's frame: the rotation of the quaternion (1, turn)
  UpperBound half_[3];
  UpperBound gram_uu_, gram_uv_, gram_vv_, drift_uu_, drift_uv_, drift_vv_, drift_a_, drift_b_, reach_, rise_,
      rest_;
};
static_assert(sizeof(SearchLeaf) == 116);

// The matrix is orthonormal up to a few roundings, whatever `turn_` is.
inline Eigen::Matrix3d SearchLeaf::Axis() const {
  const double x = turn_[0], y = turn_[1], z = turn_[2];
  const double xx = x * x, yy = y * y, zz = z * z, xy = x * y, xz = x * z, yz = y * z;
  const double one = 1.0 / (1.0 + xx + yy + zz), two = 2.0 * one;
  Eigen::Matrix3d m;
  m.col(0) << (1.0 + xx - yy - zz) * one, two * (xy + z), two * (xz - y);
  m.col(1) << two * (xy - z), (1.0 - xx + yy - zz) * one, two * (yz + x);
  m.col(2) << two * (xz + y), two * (yz - x), (1.0 - xx - yy + zz) * one;
  return m;
}

inline LeafBox SearchLeaf::Box(const LeafGrid& grid) const {
  LeafBox box{Place(grid), Axis(), Vec3(half_[0].value(), half_[1].value(), half_[2].value())};
  for (int k = 0; k < 3; ++k) box.center += (kShiftUnit * shift_[k] * box.half[k]) * box.axis.col(k);
  return box;
}

// Most boxes are decided without the frame: they are too near, or a separating plane does not rise towards
// them. With t = turn_, the coordinates of m = c - s along the axes, times 1 + t t, are
//   (1 - t t) m + 2 (t m) t - 2 t x m.
inline bool SearchLeaf::Outside(const LeafGrid& grid, const Vec3& c, double limit2) const {
  const Vec3 m = c - Place(grid), t(turn_[0], turn_[1], turn_[2]);
  const double tt = t.squaredNorm(), scale = 1.0 + tt;
  const Vec3 y = (1.0 - tt) * m + (2.0 * t.dot(m)) * t - 2.0 * t.cross(m);
  const double up[3] = {2.0 * (t.x() * t.z() - t.y()), 2.0 * (t.y() * t.z() + t.x()),
                        1.0 - t.x() * t.x() - t.y() * t.y() + t.z() * t.z()};
  double distance2 = 0.0, rise = 0.0;
  for (int k = 0; k < 3; ++k) {
    const double half = scale * static_cast<double>(half_[k].value());
    const double z = y[k] - kShiftUnit * shift_[k] * half;
    const double past = std::max(0.0, std::abs(z) - half);
    distance2 += past * past;
    rise += std::copysign(past, z) * up[k];
  }
  if (distance2 < limit2 * scale * scale) return false;
  if (rise >= 0.0) return true;
  const LeafBox box = Box(grid);
  return OrientedBoxOutside(box.center, box.axis, box.half, c, limit2);
}

inline LeafModel SearchLeaf::Model(const LeafGrid& grid) const {
  LeafModel m;
  m.gram_uu = gram_uu_.value();
  m.gram_uv = gram_uv_.value();
  m.gram_vv = gram_vv_.value();
  m.drift_uu = drift_uu_.value();
  m.drift_uv = drift_uv_.value();
  m.drift_vv = drift_vv_.value();
  m.drift_a = drift_a_.value();
  m.drift_b = drift_b_.value();
  m.reach = reach_.value();
  m.rest = rest_.value();
  m.s = Place(grid);
  m.z_max = m.s.z() + static_cast<double>(rise_.value());
  m.a = Vec3(first_[0], first_[1], first_[2]);
  m.b = Vec3(first_[3], first_[4], first_[5]);
  const double unit = second_unit_;
  m.uu = unit * Vec3(second_[0], second_[1], second_[2]);
  m.uv = unit * Vec3(second_[3], second_[4], second_[5]);
  m.vv = unit * Vec3(second_[6], second_[7], second_[8]);
  return m;
}

}  // namespace patchmill::internal
