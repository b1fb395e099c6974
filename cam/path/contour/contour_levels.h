// At which heights contours run.
#pragma once

#include <optional>
#include <vector>

#include "cam/path/contour/contour_samples.h"
#include "cam/path/contour/level_heights.h"

namespace patchmill {

struct PlannedLevel {
  double z = 0.0;           // mm, centre height
  double gap = 0.0;         // mm, to the level below (or above, for the lowest)
  bool partial = false;     // only near `spots`
  std::vector<Vec3> spots;  // centres of samples that the full levels alone would leave too far apart
};

// Levels from the top down: full ones (LevelHeights), and where the ground needs less than their gap, partial
// levels that cut it into as many parts as each spot needs. What needs steps below min_step_fraction of the
// flat one gets those; no level lies below floor_z + radius. Cost O(n log n), and LevelHeights.
// `foot`: a level of the ground below that these stand on, which is the lowest and not among them.
absl::StatusOr<std::vector<PlannedLevel>> PlanLevels(const ContourArea& contour_area,
                                                     const ContourParams& params, double radius,
                                                     std::optional<double> base_level, const RunContext& run);

// What heights follow from, of a ball of `radius` (mm).
HeightParams HeightParamsOf(const ContourParams& params, double radius);

}  // namespace patchmill
