// What is in the way of balls asked for in turn.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "cam/location/locator.h"
#include "cam/region/reach/obstacle_cloud.h"

namespace patchmill {

// Remembers what was in the way of the last balls, which mostly is in the way of the next; then asks the
// cloud; only what is left is searched for, several balls at once. For balls near each other, one after the
// other.
class ObstacleFinder {
 public:
  ObstacleFinder(const Locator& ball, const ObstacleCloud& cloud);

  // obstacles[k]: a point of the surface in the ball at centers[k] or above it, deeper than rounding; none
  // when it is free. Free as Locator::Free has it.
  void Find(std::span<const Vec3> centers, std::span<std::optional<SurfacePoint>> obstacles);

 private:
  std::optional<SurfacePoint> Known(const Vec3& center);
  void Remember(const SurfacePoint& obstacle) { last_[next_++ % last_.size()] = obstacle; }
  void Search(std::span<const Vec3> centers, std::span<std::optional<SurfacePoint>> obstacles);

  const Locator& ball_;
  const ObstacleCloud& cloud_;
  const double radius_;  // smaller than the ball's by rounding
  std::array<SurfacePoint, 8> last_;
  std::size_t next_ = 0;
  std::vector<std::size_t> open_;  // of the balls at hand
};

}  // namespace patchmill
