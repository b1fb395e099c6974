// Tests whether the ball can touch a point of the surface, and finds the reason if it cannot
// [regions, section 6]. Uses exact cutter location.
#pragma once

#include <optional>
#include <span>

#include "cam/location/locator.h"
#include "cam/location/ray_slide.h"
#include "cam/region/map/region_map.h"
#include "cam/region/reach/obstacle_cloud.h"
#include "cam/region/reach/overhang_finder.h"
#include "core/diffgeo/forms.h"

namespace patchmill {

class ReachTest {
 public:
  // `free_ball` is the locator of radius params.radius - ReachTolerance(params.tolerance). Keeps references
  // to it and to `params`. Its answers are meaningless if `run` was cancelled.
  ReachTest(const Locator& free_ball, const RegionParams& params, const RunContext& run);

  // True if the ball that touches p on the side of `facing` is free (glossary: free ball). The floor does not
  // count. If p has two sides, one free ball is enough.
  bool Free(const Vec3& p, const Facing& facing) const;
  // The same at many places near each other, faster. signs[i] is 1 if the ball is free, -1 if not, 0 if there
  // is no normal. `obstacles` is empty or as long as jets. obstacles[i] becomes a surface point in the way of
  // the ball; nullopt if there is none, or if p has two sides.
  void FreeAt(std::span<const SurfaceJet> jets, std::span<double> signs,
              std::span<std::optional<SurfacePoint>> obstacles = {}) const;
  // Distance of the point `obstacle` from the ball that touches the surface at `jet` and from its upward
  // sweep, mm. Negative if the obstacle is in the way.
  double Clearance(const Vec3& obstacle, const SurfaceJet& jet) const;
  // The same for the deepest place of the obstacle's branch of the surface. `obstacle` slides to that place.
  double Slide(RaySlide& obstacle, const SurfaceJet& jet) const;
  const Surface& surface() const { return free_ball_.surface(); }
  // For a place where the ball is not free: true for UNDERCUT [regions U1, U2, U3], false for CONCAVE. Cost:
  // some microseconds.
  bool BlockedAbove(const Vec3& p, const Facing& facing) const;
  // The same at many places near each other, faster. signs[i] is -1 for UNDERCUT, 1 for CONCAVE, 0 if there
  // is no normal.
  void BlockedAboveAt(std::span<const SurfaceJet> jets, std::span<double> signs) const;
  // Height of the ball's tip over floor_z less the reach tolerance, mm. Below 0 the place is FLOOR.
  double OverFloor(const Vec3& p, const Vec3& normal) const;
  // For a place where the ball is free: true if params.operation_limits allows its centre. If p has two
  // sides, the centre must be allowed on a side on which the ball is free.
  bool Allowed(const Vec3& p, const Facing& facing) const;
  // For a place that is not Allowed: true if only an area beside the part forbids its centre (OUTSIDE).
  bool ForbiddenBesidePart(const Vec3& p, const Facing& facing) const;
  // For a place that is not Allowed: true if it were Allowed for a shank no wider than the ball, without a
  // holder (SHANK, HOLDER).
  bool BlockedByShank(const Vec3& p, const Facing& facing) const;
  // For a place that is not Allowed: true if it were Allowed without a holder (HOLDER).
  bool BlockedByHolder(const Vec3& p, const Facing& facing) const;

  const Locator& free_ball() const { return free_ball_; }

 private:
  bool FreeCenter(const Vec3& center) const;
  template <class Allows>
  bool AllowedOnASide(const Vec3& p, const Facing& facing, const Allows& allows) const;
  // For the tool's ball, and for the smallest ball (SmallestBallRadius).
  struct OverhangFinders {
    OverhangFinder ball, smallest;
  };
  OverhangFinders MakeOverhangFinders() const;
  bool BlockedAbove(const Vec3& p, const Facing& facing, OverhangFinders& finders) const;
  const Locator& free_ball_;
  const RegionParams& params_;
  ObstacleCloud cloud_;
};

// Radius of the largest ball that touches p on the side of `facing` and is free together with its upward
// sweep, mm. It is at most `limit` and exact to limit / 4096. The surface may enter the ball by
// `reach_tolerance` (mm, ReachTolerance), so smaller balls always count as free.
double LargestFreeRadius(const Surface& surface, const Vec3& p, const Facing& facing, double limit,
                         double reach_tolerance);

}  // namespace patchmill
