// Whether the shank is what keeps a ball from a place: UNDERCUT of [regions, section 6].
#pragma once

#include <array>
#include <optional>

#include "cam/location/ray_slide.h"
#include "cam/region/reach/obstacle_cloud.h"
#include "core/surface/surface.h"

namespace patchmill {

// Remembers what was over the last balls and near them, which mostly is so for the next and settles them with
// one question.
// For balls near each other, one after the other; what an answer rests on is proven anew for each.
class ShankFinder {
 public:
  // `radius` is that of the ball that touches the ground, `free_radius` what of it must be free, both mm.
  ShankFinder(const Surface& surface, const ObstacleCloud& cloud, double free_radius, double radius);

  // Of a ball that is not free: something over the one at `center` comes nearer to its axis than anything
  // does to the centre, by 0.02 radii, with distances known to 0.001 of them; or the ball alone would be
  // free, by half of ReachTolerance.
  bool Blocked(const Vec3& center);
  // The first alone, of any ball: what is over it comes nearer than free_radius as well.
  bool StandsAbove(const Vec3& center);

 private:
  // The first half of it. `known`: KnownAbove is nearer than the free ball's radius; `near`: NearAtMost, or
  // more.
  bool ShankIsNearer(const Vec3& center, bool known, double near);
  // The second.
  bool BallClears(const Vec3& center, double near);
  // At least the distance of the nearest surface point from the centre, by the points known; at most `most`.
  double NearAtMost(const Vec3& center, double most);
  // What was nearest to other centres comes nearer than `limit` when it slides to this one.
  bool SlidesNear(const Vec3& center, double limit);
  // Of the distance of the known points over `center` from its axis the least.
  double KnownAbove(const Vec3& center) const;

  const Surface& surface_;
  const ObstacleCloud& cloud_;
  const double free_radius_, radius_;
  const double clear_;  // halfway between the two: the ball alone is free when nothing is nearer
  const double proof_, nearer_;
  Vec3 near_ = Vec3::Constant(kInfinity);          // what was nearest last
  std::array<std::optional<RaySlide>, 4> slides_;  // what searches have found near
  std::array<Vec3, 8> last_;                       // what was above
  std::size_t next_slide_ = 0, next_ = 0;
};

}  // namespace patchmill
