// A leaf of the bounds hierarchy: a part of a piece and an oriented box that holds it, in 72 bytes.
//
// The frame of the box is stored rounded, and the box is measured in the stored frame. The half sides are
// rounded up. So the stored box is a true bound, larger than the exact one by less than 2e-7 of the leaf's
// size.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/typed_id.h"
#include "core/base/vec.h"

namespace patchmill {

// Outer bounds of a sub-rectangle of a piece.
struct RectBounds {
  Box3 box;  // axis-parallel
  // The oriented box: |(x - center) . axis.col(k)| <= half[k] for every x of the rectangle, rounded outward
  // by a few ulps of the coordinates. `axis` is orthonormal to 1e-15 and right-handed. col(2) is the mean
  // normal (along du x dv), col(0) runs along the longer side.
  Vec3 center = Vec3::Zero();
  Eigen::Matrix3d axis = Eigen::Matrix3d::Identity();
  Vec3 half = Vec3::Zero();
};

class SurfaceLeaf {
 public:
  PieceId piece;
  float u0 = 0, u1 = 1, v0 = 0, v1 = 1;  // dyadic, hence exact

  // Sets the box of the hull's points in the frame `axis` (right-handed, orthonormal). At least one point.
  void SetBox(const Eigen::Matrix3d& axis, const Vec3* hull, int hull_count);

  const Vec3& center() const { return center_; }
  Eigen::Matrix3d axis() const;
  Vec3 half() const { return {half_[0], half_[1], half_[2]}; }
  // All bounds of the leaf. `box` is the leaf's box in the tree.
  RectBounds Bounds(const Box3& box) const { return {box, center_, axis(), half()}; }

 private:
  std::array<std::int32_t, 4> turn_ = {0, 0, 0, 1};  // the frame as a quaternion (x, y, z, w) of any length
  std::array<float, 3> half_ = {0, 0, 0};
  Vec3 center_ = Vec3::Zero();
};
static_assert(sizeof(SurfaceLeaf) == 72);

// The matrix is orthonormal up to a few roundings, because the quaternion is divided by its own length.
inline Eigen::Matrix3d SurfaceLeaf::axis() const {
  const double x = turn_[0], y = turn_[1], z = turn_[2], w = turn_[3];
  const double xx = x * x, yy = y * y, zz = z * z, ww = w * w, one = 1.0 / (ww + xx + yy + zz),
               two = 2.0 * one;
  Eigen::Matrix3d m;
  m.col(0) << (ww + xx - yy - zz) * one, two * (x * y + w * z), two * (x * z - w * y);
  m.col(1) << two * (x * y - w * z), (ww - xx + yy - zz) * one, two * (y * z + w * x);
  m.col(2) << two * (x * z + w * y), two * (y * z - w * x), (ww - xx - yy + zz) * one;
  return m;
}

}  // namespace patchmill
