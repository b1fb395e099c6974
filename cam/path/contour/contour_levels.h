// The heights at which contours run.
#pragma once

#include <optional>
#include <vector>

#include "cam/path/contour/contour_samples.h"
#include "cam/path/contour/level_heights.h"

namespace patchmill {

struct PlannedLevel {
  double z = 0.0;           // mm, centre height
  double gap = 0.0;         // mm, to the level below (or above, for the lowest)
  bool partial = false;     // the level runs only near `spots`
  std::vector<Vec3> spots;  // centres of samples that the full levels alone would leave too far apart
};

// Returns the levels from the top down: the full ones (LevelHeights), and partial levels where the surface
// needs less than their gap. Partial levels divide the gap into as many parts as each spot needs. Where less
// than min_step_fraction of the flat step-over is needed, levels keep that fraction. No level lies below
// floor_z + radius. `base_level` is a level of the group below on which these levels stand; it counts as the
// lowest one and is not in the result. Cost O(n log n), and LevelHeights.
absl::StatusOr<std::vector<PlannedLevel>> PlanLevels(const ContourArea& contour_area,
                                                     const ContourParams& params, double radius,
                                                     std::optional<double> base_level, const RunContext& run);

// Returns the parameters from which heights follow, for a ball of `radius` (mm).
HeightParams HeightParamsOf(const ContourParams& params, double radius);

}  // namespace patchmill
