// Whether the shank is what keeps a ball from a place: UNDERCUT of docs/reach.md.
#pragma once

#include <array>

#include "cam/location/locator.h"
#include "cam/region/obstacle_cloud.h"

namespace patchmill {

// Remembers what was over the last balls, which mostly is over the next and settles them with one question.
// For balls near each other, one after the other; what an answer rests on is proven anew for each.
class ShankFinder {
 public:
  // `ball` is the free ball of ReachTest, `radius` that of the tool with the stock to leave.
  ShankFinder(const Locator& ball, const ObstacleCloud& cloud, double radius);

  // Something over the ball at `center` comes nearer to its axis than anything does to the centre, by 0.02
  // radii; distances are known to 0.001 of them.
  bool Blocked(const Vec3& center);

 private:
  // Of the distance of the known points over `center` from its axis the least.
  double KnownAbove(const Vec3& center) const;

  const Surface& surface_;
  const ObstacleCloud& cloud_;
  const double ball_radius_, radius_, proof_, nearer_;
  Vec3 near_ = Vec3::Constant(kInfinity);  // what was nearest last
  std::array<Vec3, 8> last_;               // what was above
  std::size_t next_ = 0;
};

}  // namespace patchmill
