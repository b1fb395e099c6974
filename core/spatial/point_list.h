// A growing list of points, searched for near ones four at a time.
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/vec.h"

namespace patchmill {

class PointList {
 public:
  void Add(const Vec3& p);
  std::size_t size() const { return size_; }
  // Number of the first point, from number `from` on, that may be nearer to p than `distance` (mm, may be
  // infinite); size() if there is none. It compares in float: no nearer point is skipped, but the point found
  // may be a little farther away. Cost: about ten instructions for four points.
  std::size_t FirstNear(const Vec3& p, double distance, std::size_t from) const;

 private:
  Vec3 origin_ = Vec3::Zero();    // the first point
  std::vector<float> x_, y_, z_;  // relative to the origin, rounded; three more at the end
  std::size_t size_ = 0;
  double extent_ = 0.0;  // mm, largest absolute coordinate relative to the origin
};

}  // namespace patchmill
