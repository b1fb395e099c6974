// Points of the surface by their place in plan: a quick proof that something is in a ball's way.
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
  // Points about `spacing` (mm, > 0) apart on every piece; wider apart where a million would not do. Cost:
  // some 0.1 us a point. Cut short when `run` is cancelled.
  ObstacleCloud(const Surface& surface, double spacing, const RunContext& run);

  // A point of the cloud nearer than `radius` to the upward vertical ray at c; its parameters are floats.
  // Nothing proves nothing. Cost: 1 ns a point of the disc of this radius.
  std::optional<SurfacePoint> InTheWay(const Vec3& c, double radius) const;
  // The point of the cloud nearest to c, where one is nearer than `limit`; the less that is, the faster.
  std::optional<Vec3> Nearest(const Vec3& c, double limit) const;

 private:
  struct Parameters {
    std::int32_t piece = 0;
    float u = 0.0F, v = 0.0F;
  };
  // visit(first, last): points some of which may be nearer to the ray than `reach`, which may shrink on the
  // way; until it says true.
  template <class Visit>
  void Runs(const Vec3& c, const double& reach, const Visit& visit) const;
  Float4 Squared(double distance) const;

  Vec3 low_ = Vec3::Zero();
  double cell_ = 1.0;
  float slack_ = 0.0F;  // mm: what rounding to floats may do to a distance
  int rows_ = 0, columns_ = 0;
  std::vector<std::size_t> first_;  // [row * columns + column]: of the cell's points, and the end
  std::vector<float> highest_;      // of a cell, from low; some more at the end
  std::vector<Vec3> points_;
  std::vector<float> x_, y_, z_;  // of the points from low, rounded; some more at the end
  std::vector<Parameters> at_;    // of each point
};

}  // namespace patchmill
