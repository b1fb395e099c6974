// A growing list of points that is looked through for near ones, four at a time.
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/vec.h"

namespace patchmill {

class PointList {
 public:
  void Add(const Vec3& p);
  std::size_t size() const { return size_; }
  // Of all from `from` on the first that may be nearer than `distance` (mm, may be infinite) to p, as far as
  // floats tell: none that is nearer is passed by. size() where there is none. Cost: some ten instructions
  // for four.
  std::size_t FirstNear(const Vec3& p, double distance, std::size_t from) const;

 private:
  Vec3 origin_ = Vec3::Zero();    // the first point
  std::vector<float> x_, y_, z_;  // from the origin, rounded; three more at the end
  std::size_t size_ = 0;
  double extent_ = 0.0;  // mm, largest coordinate from the origin
};

}  // namespace patchmill
