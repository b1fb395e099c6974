// Can the ball touch this point of the surface, and if not, why: docs/reach.md, by exact cutter location.
#pragma once

#include "cam/location/locator.h"
#include "cam/region/region_map.h"

namespace patchmill {

class ReachTest {
 public:
  // `free_ball`: locator of radius params.radius - params.tolerance.
  ReachTest(const Locator& free_ball, const RegionParams& params) : free_ball_(free_ball), params_(params) {}

  // Where there is no normal: kNone (a point has no area). Cost some microseconds where something blocks.
  UnreachableReason Reason(const Piece& piece, double u, double v) const;
  // Reason() == kNone, at a fraction of its cost.
  bool Reachable(const Piece& piece, double u, double v) const;

  // Rough depth of material left over p when it is unreachable: from the ball that comes down right above it.
  double LeftoverAbove(const Vec3& p) const;

 private:
  UnreachableReason At(const Vec3& center) const;
  bool AboveFloor(const Vec3& center) const;
  bool Allowed(const Vec3& center) const;
  const Locator& free_ball_;
  const RegionParams& params_;
};

// Largest ball (mm, radius) that touches p from the side of `normal` and is free upward, at most `limit`.
double LargestFreeRadius(const Surface& surface, const Vec3& p, const Vec3& normal, double limit,
                         double tolerance);

}  // namespace patchmill
