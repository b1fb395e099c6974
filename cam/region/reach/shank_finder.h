// Tests whether something above a ball, in the way of its shank, keeps it from a place: UNDERCUT of
// [regions, section 6].
#pragma once

#include <array>
#include <optional>

#include "cam/location/ray_slide.h"
#include "cam/region/reach/obstacle_cloud.h"
#include "core/surface/surface.h"

namespace patchmill {

// Use it for balls near each other, one after the other. It remembers points above and near the last balls.
// With these points one query often settles the next ball. Each answer is proven anew.
class ShankFinder {
 public:
  // `radius` is that of the ball that touches the surface. Within `free_radius` nothing may be in its way.
  // Both in mm.
  ShankFinder(const Surface& surface, const ObstacleCloud& cloud, double free_radius, double radius);

  // For a ball that is not free. True if something above the centre comes nearer to the axis than anything
  // comes to the centre, by 0.02 radii; distances are known to 0.001 radii. Also true if the ball without its
  // upward sweep would be free: if the surface enters it by at most half of the reach tolerance.
  bool Blocked(const Vec3& center);
  // For any ball: the first of these conditions alone, and what stands above is nearer than free_radius.
  bool StandsAbove(const Vec3& center);

 private:
  // The first condition. `known` says that KnownAbove is below the free radius. `near` is NearAtMost or more.
  bool ShankIsNearer(const Vec3& center, bool known, double near);
  // The second condition.
  bool BallClears(const Vec3& center, double near);
  // An upper bound for the distance from the centre to the surface, from known points; at most `most`.
  double NearAtMost(const Vec3& center, double most);
  // True if a point that was nearest to another centre slides to within `limit` of this one.
  bool SlidesNear(const Vec3& center, double limit);
  // Least distance from the axis to a known point above `center`.
  double KnownAbove(const Vec3& center) const;

  const Surface& surface_;
  const ObstacleCloud& cloud_;
  const double free_radius_, radius_;
  const double clear_;           // halfway between the two radii: the ball alone is free if nothing is nearer
  const double proof_, nearer_;  // mm
  Vec3 near_ = Vec3::Constant(kInfinity);          // the last nearest point
  std::array<std::optional<RaySlide>, 4> slides_;  // near points that searches found
  std::array<Vec3, 8> last_;                       // the last points above
  std::size_t next_slide_ = 0, next_ = 0;
};

}  // namespace patchmill
