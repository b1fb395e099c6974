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

// Returns the levels from the top down: the full levels (LevelHeights), and partial levels between two full
// ones where samples need a smaller z-step than the gap. Partial levels divide the gap there into as many
// equal parts as the sample needs (PartsOfGap). No z-step is smaller than min_step_fraction of the flat
// step-over, whatever a sample needs. No level lies below floor_z + radius. `base_level` (mm, height of the
// centre) is the level of the group below on which a branch stands; it serves as the lowest level and is not
// in the result. Cost: O(n log n) for n samples, and LevelHeights.
absl::StatusOr<std::vector<PlannedLevel>> PlanLevels(const ContourArea& contour_area,
                                                     const ContourParams& params, double radius,
                                                     std::optional<double> base_level, const RunContext& run);

// Returns the parameters of LevelHeights for a ball of `radius` (mm).
HeightParams HeightParamsOf(const ContourParams& params, double radius);

}  // namespace patchmill
