// Can the ball touch this point of the surface, and if not, why: [regions, section 6], by exact cutter
// location.
#pragma once

#include <optional>
#include <span>

#include "cam/location/locator.h"
#include "cam/location/ray_slide.h"
#include "cam/region/map/region_map.h"
#include "cam/region/reach/obstacle_cloud.h"
#include "cam/region/reach/shank_finder.h"
#include "core/diffgeo/forms.h"

namespace patchmill {

class ReachTest {
 public:
  // `free_ball`: locator of radius params.radius - ReachTolerance(params.tolerance). Of a cancelled `run` its
  // answers mean nothing.
  ReachTest(const Locator& free_ball, const RegionParams& params, const RunContext& run);

  // The ball that touches p from where `facing` says is free; the floor does not count. Of two sides either
  // will do.
  bool Free(const Vec3& p, const Facing& facing) const;
  // The same at many places near each other, faster: signs[i] = 1 free, -1 not, 0 where there is no normal.
  // `obstacles`, as many or none: something in the way of the ball, where it is known and decides.
  void FreeAt(std::span<const SurfaceJet> jets, std::span<double> signs,
              std::span<std::optional<SurfacePoint>> obstacles = {}) const;
  // How far an obstacle is outside the ball that touches the surface at `jet` and all above it, mm; negative
  // when it is in the way.
  double Clearance(const Vec3& obstacle, const SurfaceJet& jet) const;
  // The same of the deepest place of the obstacle's branch of the surface, which `obstacle` slides to.
  double Slide(RaySlide& obstacle, const SurfaceJet& jet) const;
  const Surface& surface() const { return free_ball_.surface(); }
  // Where it is not: UNDERCUT, and not CONCAVE. Cost some microseconds.
  bool BlockedAbove(const Vec3& p, const Facing& facing) const;
  // The same at many places near each other, faster: signs[i] = -1 blocked above, 1 not, 0 where there is no
  // normal.
  void BlockedAboveAt(std::span<const SurfaceJet> jets, std::span<double> signs) const;
  // Height of its tip over the floor, mm, the slack for rounding counted in: below 0 the place is FLOOR.
  double OverFloor(const Vec3& p, const Vec3& normal) const;
  // Of a place where the ball is free: params.operation_limits allows its centre. Of two sides on the one
  // where the
  // ball is free.
  bool Allowed(const Vec3& p, const Facing& facing) const;
  // Where it is not: it would be, on one of the sides, if nothing were forbidden beside the part.
  bool ForbiddenBesidePart(const Vec3& p, const Facing& facing) const;
  // The same if the shank were no wider than the ball.
  bool BlockedByShank(const Vec3& p, const Facing& facing) const;

  const Locator& free_ball() const { return free_ball_; }

 private:
  bool FreeCenter(const Vec3& center) const;
  template <class Allows>
  bool AllowedOnASide(const Vec3& p, const Facing& facing, const Allows& allows) const;
  struct Shanks {
    ShankFinder ball, least;
  };
  Shanks MakeShanks() const;
  bool BlockedAbove(const Vec3& p, const Facing& facing, Shanks& shanks) const;
  const Locator& free_ball_;
  const RegionParams& params_;
  ObstacleCloud cloud_;
};

// Largest ball (mm, radius) that touches p from where `facing` says and is free upward, at most `limit`; to
// limit / 4096. All of at most `give` (mm, ReachTolerance) count as free.
double LargestFreeRadius(const Surface& surface, const Vec3& p, const Facing& facing, double limit,
                         double reach_tolerance);

}  // namespace patchmill
