// In which direction the zig-zag lines of each region take the least time.
#pragma once

#include <functional>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/link/link_paths.h"
#include "cam/plan/job.h"

namespace patchmill {

// s, estimated, of the motion that cuts each region, the ways to its passes included.
using RegionTimes = std::vector<double>;
RegionTimes TimesOf(const LinkResult& motion, std::size_t regions);

// Plans a whole job with these choices, links and rest passes and all.
using TimePlan = std::function<absl::StatusOr<RegionTimes>(const std::vector<RegionChoice>& choices)>;

inline constexpr int kQuickestAnglePlans = 7;

// The choices with zigzag_angle filled in wherever angle_open is set (which is cleared): all regions are
// planned at 0, 30, ... 150 degrees; each takes the angle at which its own motion is quickest (steep ones
// that contours cut that of the quickest plan), and that mixture is planned too. The quickest of these
// kQuickestAnglePlans plans is the answer. That many times the cost of `plan`; its errors.
absl::StatusOr<std::vector<RegionChoice>> QuickestAngles(const RegionMap& map,
                                                         std::vector<RegionChoice> choices,
                                                         const TimePlan& plan);

}  // namespace patchmill
