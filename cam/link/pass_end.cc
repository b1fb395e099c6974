#include "cam/link/pass_end.h"

namespace patchmill {

const CutterPoint& PassEnd::Inner(std::size_t k) const {
  const std::size_t index = is_start_ ? k : Count() - 1 - k;
  return pass_->points[index % pass_->points.size()];
}

const CutterPoint& PassEnd::point() const { return Inner(0); }

Vec3 PassEnd::Along() const {
  for (std::size_t k = 1; k < Count(); ++k) {
    const Vec3 inwards = Inner(k).center - center();
    const double length = inwards.norm();
    if (length > 1e-6) return (is_start_ ? 1.0 : -1.0) / length * inwards;
  }
  return Vec3::Zero();
}

std::vector<Vec3> PassEnd::Inwards(double length) const {
  std::vector<Vec3> places = {center()};
  double left = length;
  for (std::size_t k = 1; k < Count() && left > 0.0; ++k) {
    const Vec3 step = Inner(k).center - places.back();
    const double along = step.norm();
    if (along == 0.0) continue;
    places.push_back(along <= left ? Inner(k).center : Vec3(places.back() + left / along * step));
    left -= along;
  }
  return places;
}

}  // namespace patchmill
