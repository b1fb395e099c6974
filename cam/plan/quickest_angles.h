// In which direction the zig-zag lines of each region take the least time.
#pragma once

#include <functional>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/link/link_paths.h"
#include "cam/plan/job.h"
#include "cam/plan/region_choices.h"

namespace patchmill {

// s, estimated, of the motion that cuts each region, the ways to its passes included.
using RegionTimes = std::vector<double>;
RegionTimes TimesOf(const LinkResult& motion, std::size_t regions);

// Plans a whole job with these choices, links and rest passes and all. One that passes the limits of passes
// (LimitPassedError) is no choice, others may be.
using TimePlan = std::function<absl::StatusOr<RegionTimes>(const std::vector<RegionChoice>& choices)>;

inline constexpr int kQuickestAnglePlans = 20;  // at most

// The choices with zigzag_angle filled in, in [0, pi), wherever it is open, or with more `around` from
// `trials`, which has the circles to try for each region (ChooseCircularLines).
//
// First all regions are planned at 0, 30, ... 150 degrees and along the two main directions of the borders at
// which lines end (MainDirections), because near these the time falls within a few degrees. Each region takes
// the angle at which its own motion is quickest; steep regions that contours cut take that of the quickest
// plan. That mixture is planned, too. Then the angles of the quickest plan are turned by 15 degrees to either
// side, by 7.5 and by 3.75, and each region takes the quickest of the three. At last circles replace lines
// wherever there are trials, and stay where they are quicker. The answer is the quickest of all these plans.
// Cost: kQuickestAnglePlans times that of `plan` at most. Errors: those of `plan`.
absl::StatusOr<std::vector<RegionChoice>> QuickestAngles(const RegionMap& map, const RegionChoices& chosen,
                                                         const std::vector<CircularTrial>& trials,
                                                         const TimePlan& plan);

}  // namespace patchmill
