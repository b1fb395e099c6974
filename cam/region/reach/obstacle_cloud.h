// Points of the surface, sorted by their place in plan. They prove quickly that something is in a ball's way.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/lanes.h"
#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

class ObstacleCloud {
 public:
  // Puts points about `spacing` (mm, > 0) apart on every piece. They are farther apart if this would take
  // more than about a million points. Cost: some 0.1 us per point. Incomplete if `run` is cancelled.
  ObstacleCloud(const Surface& surface, double spacing, const RunContext& run);

  // A point of the cloud nearer than `radius` to the upward ray at c; its parameters are rounded to floats.
  // nullopt proves nothing. Cost: 1 ns per point of the cloud in the disc of this radius.
  std::optional<SurfacePoint> InTheWay(const Vec3& c, double radius) const;
  // The point of the cloud nearest to c; nullopt if none is nearer than `limit`. A small limit is faster.
  std::optional<Vec3> Nearest(const Vec3& c, double limit) const;

 private:
  struct Parameters {
    std::int32_t piece = 0;
    float u = 0.0F, v = 0.0F;
  };
  // Calls visit(first, last) for index ranges that together contain all points nearer to the upward ray at c
  // than `reach` (mm), until visit returns true. `reach` may shrink meanwhile.
  template <class Visit>
  void Runs(const Vec3& c, const double& reach, const Visit& visit) const;
  Float4 Squared(double distance) const;

  Vec3 low_ = Vec3::Zero();
  double cell_ = 1.0;
  float slack_ = 0.0F;  // mm; error of a distance by rounding to floats
  int rows_ = 0, columns_ = 0;
  std::vector<std::size_t> first_;  // [row * columns + column]: first point of the cell; then the end
  std::vector<float> highest_;      // [cell]: largest z above low_; some extra entries at the end
  std::vector<Vec3> points_;
  std::vector<float> x_, y_, z_;  // [point]: relative to low_, rounded; some extra entries at the end
  std::vector<Parameters> at_;    // [point]
};

}  // namespace patchmill
