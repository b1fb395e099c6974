// The unreachable area of a part by brute force, to check planner and verifier. It takes random places of
// every patch in its native form, with normals by differences. The ball at each place is compared with dense
// samples of all patches; the nearest sample is improved by a direct search. It uses no pieces, no bounds and
// no derivatives.
#pragma once

#include <vector>

#include "core/network/patch_model.h"
#include "tests/support/random.h"

namespace patchmill::testing {

struct ReachQuestion {
  double radius = 3.0;          // mm, ball and stock to leave
  double tolerance = 0.01;      // mm: a ball is free that fits but for half of it
  double floor_z = -kInfinity;  // mm, lowest tip
};

// mm^2; `deviation`: the standard deviation of the count.
struct ReachCount {
  double area = 0.0, unreachable = 0.0, deviation = 0.0;
};

// Some `places` places, spread evenly over the area, two to a cell. [regions (6)] is the rule.
ReachCount CountUnreachable(const PatchModel& model, const ReachQuestion& question, int places,
                            Random& random);

}  // namespace patchmill::testing
