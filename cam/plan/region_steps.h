// How far apart passes may lie in each region, and how long they must be together.
#pragma once

#include <vector>

#include "cam/location/locator.h"
#include "cam/plan/job.h"
#include "cam/plan/resolve.h"

namespace patchmill {

// Fills step_min and step_max of every reachable region: the smallest and the largest distance between
// neighbouring ball centres, measured on the centre surface across the feed of the region's strategy, that
// leaves exactly its scallop (CenterStep). And otherwise_share: how much of its area is steep in a gentle
// region or gentle in a steep one, left in it by merging, where its strategy is kAuto. Taken at up to about
// 200,000 points spread over the regions in patch parameters; points where the ball does not fit (kappa R >=
// 1) do not count, and both stay 0 when no other is seen. CANCELLED, DEADLINE_EXCEEDED from `run`.
absl::Status FillSteps(const Surface& surface, const std::vector<RegionChoice>& choices,
                       const Resolved& resolved, const RunContext& run, RegionMap& map);

// mm: the integral of the centre surface's area over the widest step at each place, which is CenterStep
// across the most convex direction, over the reachable ground that is selected and not skipped, less what
// forced passes leave as STRATEGY. No passes that leave the scallop everywhere can be shorter: a mm of pass
// takes care of no more than the widest step beside it. Upright ground counts from the side where the ball
// finds room, by a few places of each piece in a region; the shorter of two. The same points as FillSteps.
// `locator`: of resolved.plan_radius. CANCELLED, DEADLINE_EXCEEDED from `run`.
absl::StatusOr<double> LeastCutLength(const Locator& locator, const std::vector<RegionChoice>& choices,
                                      const Resolved& resolved, const RunContext& run, const RegionMap& map);

// Fills wanted_share: how much of the area of every region is selected (IsWanted), 0 to 1, by the same
// points; 1 where none of them is seen. CANCELLED, DEADLINE_EXCEEDED from `run`.
absl::Status FillWantedShares(const Surface& surface, const Containment& containment, const RunContext& run,
                              RegionMap& map);

}  // namespace patchmill
