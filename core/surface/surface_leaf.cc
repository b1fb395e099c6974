#include "core/surface/surface_leaf.h"

#include <cmath>

#include <Eigen/Geometry>

#include "core/surface/net_kernel.h"

namespace patchmill {

void SurfaceLeaf::SetBox(const Eigen::Matrix3d& axis, const Vec3* hull, int hull_count) {
  const Eigen::Vector4d q = Eigen::Quaterniond(axis).coeffs().normalized();
  for (int k = 0; k < 4; ++k) {
    turn_[static_cast<std::size_t>(k)] = static_cast<std::int32_t>(std::lround(2147483000.0 * q[k]));
  }
  const RectBounds bounds = BoundInFrame(this->axis(), hull, hull_count);
  center_ = bounds.center;
  for (int k = 0; k < 3; ++k) {
    half_[static_cast<std::size_t>(k)] = std::nextafterf(static_cast<float>(bounds.half[k]), HUGE_VALF);
  }
}

}  // namespace patchmill
