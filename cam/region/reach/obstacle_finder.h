// Finds obstacles: what is in the way of balls, one after the other.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "cam/location/locator.h"
#include "cam/region/reach/obstacle_cloud.h"

namespace patchmill {

// Tries the obstacles of the last balls first, because these mostly are in the way of the next ball, too.
// Then it asks the cloud. Only for the balls that are left does it search the surface, for several at once.
// Use it for balls near each other, one after the other.
class ObstacleFinder {
 public:
  ObstacleFinder(const Locator& ball, const ObstacleCloud& cloud);

  // Sets obstacles[k] to a point of the surface that lies in the ball at centers[k] or in its upward sweep by
  // more than rounding. nullopt if the ball is free in the sense of Locator::Free.
  void Find(std::span<const Vec3> centers, std::span<std::optional<SurfacePoint>> obstacles);

 private:
  std::optional<SurfacePoint> Known(const Vec3& center);
  void Remember(const SurfacePoint& obstacle) { last_[next_++ % last_.size()] = obstacle; }
  void Search(std::span<const Vec3> centers, std::span<std::optional<SurfacePoint>> obstacles);

  const Locator& ball_;
  const ObstacleCloud& cloud_;
  const double radius_;  // radius of the ball less rounding
  std::array<SurfacePoint, 8> last_;
  std::size_t next_ = 0;
  std::vector<std::size_t> open_;  // balls of the current call that wait for a search
};

}  // namespace patchmill
