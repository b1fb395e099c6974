// Finds obstacles: surface points that are in the way of balls or their upward sweeps.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "cam/location/locator.h"
#include "cam/region/reach/obstacle_cloud.h"

namespace patchmill {

// First it tries the obstacles of the last balls, which are mostly in the way of the next ball, too. Then it
// looks for a point of the cloud. Only for the remaining balls does it search the surface, for several balls
// at once. Order the balls so that each is near the last.
class ObstacleFinder {
 public:
  ObstacleFinder(const Locator& ball, const ObstacleCloud& cloud);

  // Sets obstacles[k] to a surface point that is in the ball at centers[k] or in its upward sweep by more
  // than rounding; to nullopt if there is none, so that the ball is free (Locator::Free).
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
