#include "core/spatial/point_list.h"

#include <algorithm>
#include <bit>

#include "core/base/lanes.h"

namespace patchmill {
namespace {

constexpr std::size_t kLanes = 4;
constexpr double kFloat = 1e-6;  // share of the coordinates; more than their rounding changes a distance

}  // namespace

void PointList::Add(const Vec3& p) {
  if (size_ == 0) origin_ = p;
  const Vec3 q = p - origin_;
  extent_ = std::max(extent_, q.cwiseAbs().maxCoeff());
  ++size_;
  const auto put = [&](std::vector<float>& to, double value) {
    to.resize(size_ + kLanes - 1);
    to[size_ - 1] = static_cast<float>(value);
  };
  put(x_, q.x());
  put(y_, q.y());
  put(z_, q.z());
}

std::size_t PointList::FirstNear(const Vec3& p, double distance, std::size_t from) const {
  const Vec3 q = p - origin_;
  const auto most = static_cast<float>(distance + kFloat * (extent_ + q.cwiseAbs().maxCoeff()));
  const Float4 x = Splat(static_cast<float>(q.x())), y = Splat(static_cast<float>(q.y())),
               z = Splat(static_cast<float>(q.z())), limit = Splat(1.00001F * most * most);
  for (std::size_t i = from; i < size_; i += kLanes) {
    const Float4 dx = Load(x_, i) - x, dy = Load(y_, i) - y, dz = Load(z_, i) - z;
    const unsigned bits = BelowBits(dx * dx + dy * dy + dz * dz, limit);
    if (bits != 0) return std::min(size_, i + static_cast<std::size_t>(std::countr_zero(bits)));
  }
  return size_;
}

}  // namespace patchmill
