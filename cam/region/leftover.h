// What stays over a place that no free ball touches: the distance to the nearest centre where one may stand,
// less R (the leftover of DESIGN 2, with all of those centres as the path).
#pragma once

#include <span>

#include "cam/location/keep_in.h"
#include "cam/location/locator.h"
#include "core/base/run_context.h"

namespace patchmill {

struct LeftoverParams {
  double floor_z = -kInfinity;      // mm, lowest tip
  const KeepIn* keep_in = nullptr;  // null: allows all centres
};

struct Deepest {
  double leftover = 0.0;  // mm, >= 0
  std::size_t place = 0;  // position of the place it stays over; 0 where nothing does
};

// The largest over `places`, points of the surface, of a ball of locator.radius(). Measured to centres that
// are free, so a place's own is never too small; too large where the search for the nearest ends in another
// local minimum. What is at most a fiftieth deeper than another, and R / 1000, is not looked for. The
// diagonal of the surface's box at most, and where nothing is allowed within 32 R of a place. `normals`, as
// many or none: the unit normals there, upwards, zero where there is none; with them a ball that has hardly
// any room, as in a hole of its own size, is looked for on their side too. Cost: a height a place, ten for
// those that may be the deepest, two hundred for the few that are, up to six hundred for the deepest, whose
// nearest centre is searched for all around; more under limits. Means nothing when
// `run` was cancelled meanwhile.
Deepest DeepestLeftover(const Locator& locator, const LeftoverParams& params, std::span<const Vec3> places,
                        const RunContext& run, std::span<const Vec3> normals = {});

}  // namespace patchmill
