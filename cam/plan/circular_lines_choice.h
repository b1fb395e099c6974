// Which regions have their lines in circles: rims, shoulders, whatever gentle ground lies around an axis.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/plan/job.h"
#include "cam/plan/resolve.h"

namespace patchmill {

// Gives `around` to the choices whose circles_open is set (which is cleared) where it pays: of reachable
// regions cut in the way that suits them (strategy AUTO), both ways; each component of a region by itself, so
// that every one of many rims has circles of its own (up to 5 million over the number of pieces). What counts
// is their gentle ground that is wanted, all of a gentle region, and of a steep one what merging left in it.
// The circles' place c is where normals point to and borders run around: the least sum of squares of m . (p -
// c), over points p, by area, of their horizontal direction m square to the normal (as long as the slope's
// sine), and over the borders of gentle ground of their direction m, by length times a flat step; what misses
// c by more than a ball radius counts less. Circles pay where their length, the way to each run included, is
// a tenth shorter than that of straight lines at their angle, both estimated from the steps needed at the
// points of FillSteps (one in four of them) and from how many lines end at borders and at the split angle.
// Only for ground that goes around the place, three quarters of the way at least, and that keeps a ball
// radius and a step away from it; what merging left in steep regions also has borders that run along the
// circles, but for an angle of 0.2 on average. Where the angle is open they are compared with the best of
// six: circles a fifth shorter need no angle, and where all lines of the region are such angle_open is
// cleared; such as are less than a fifth longer are told, by region, to be tried (QuickestAngles), for the
// estimate may err by that. CANCELLED, DEADLINE_EXCEEDED from `run`.
absl::StatusOr<std::vector<CircularTrial>> ChooseCircularLines(const Surface& surface, const RegionMap& map,
                                                               const Resolved& resolved,
                                                               const RunContext& run,
                                                               std::vector<RegionChoice>& choices);

}  // namespace patchmill
