#include "cam/region/reach/obstacle_finder.h"

#include <algorithm>
#include <cmath>

#include "cam/location/simd/heights.h"
#include "core/surface/box_distance.h"

namespace patchmill {
namespace {

constexpr double kRounding = 1e-9;    // in R: obstacles must be deeper than this
constexpr std::size_t kTogether = 8;  // balls in one search of the surface

}  // namespace

ObstacleFinder::ObstacleFinder(const Locator& ball, const ObstacleCloud& cloud)
    : ball_(ball), cloud_(cloud), radius_(ball.radius() * (1.0 - kRounding)) {
  last_.fill({PieceId(), 0.0, 0.0, Vec3::Constant(kInfinity)});
}

std::optional<SurfacePoint> ObstacleFinder::Known(const Vec3& center) {
  for (const SurfacePoint& obstacle : last_) {
    if (FromSet<Reach::kUpwardRay>(obstacle.p - center).squaredNorm() < radius_ * radius_) return obstacle;
  }
  const std::optional<SurfacePoint> obstacle = cloud_.InTheWay(center, radius_);
  if (obstacle) Remember(*obstacle);
  return obstacle;
}

void ObstacleFinder::Find(std::span<const Vec3> centers, std::span<std::optional<SurfacePoint>> obstacles) {
  open_.clear();
  for (std::size_t i = 0; i < centers.size(); ++i) {
    obstacles[i] = Known(centers[i]);
    if (!obstacles[i]) open_.push_back(i);
    if (open_.size() == kTogether) Search(centers, obstacles);
  }
  Search(centers, obstacles);
}

void ObstacleFinder::Search(std::span<const Vec3> centers, std::span<std::optional<SurfacePoint>> obstacles) {
  std::array<Vec3, kTogether> asked;
  std::array<std::optional<SurfacePoint>, kTogether> found;
  for (std::size_t k = 0; k < open_.size(); ++k) asked[k] = centers[open_[k]];
  FindObstacles(ball_, std::span(asked).first(open_.size()), std::span(found).first(open_.size()));
  for (std::size_t k = 0; k < open_.size(); ++k) {
    obstacles[open_[k]] = found[k];
    if (found[k]) Remember(*found[k]);
  }
  open_.clear();
}

}  // namespace patchmill
