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

// The choices with zigzag_angle filled in, in [0, pi), wherever angle_open is set (which is cleared), or
// more `around` from `circles`, which has what to try for each region (ChooseCircularLines). First all
// regions are planned at 0, 30, ... 150 degrees and along the two directions in which most of the borders of
// lines run (MainDirections), for there the time falls off within a few degrees. Each region takes the angle
// at which its own motion is quickest (steep ones that contours cut that of the quickest plan), and that
// mixture is planned too. Then the quickest plan's angles are turned by 15 degrees to either side, by 7.5 and
// by 3.75, and each region takes the one of the three that its own motion is quickest at; at last circles
// take the place of lines wherever they are to be tried, and where they are quicker they stay. The quickest
// of all these plans is the answer. kQuickestAnglePlans times the cost of `plan` at most; its errors.
absl::StatusOr<std::vector<RegionChoice>> QuickestAngles(const RegionMap& map,
                                                         std::vector<RegionChoice> choices,
                                                         const std::vector<CircularTrial>& circles,
                                                         const TimePlan& plan);

}  // namespace patchmill
