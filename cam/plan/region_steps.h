// How far apart passes may lie in each region, and how long they must be together.
#pragma once

#include <vector>

#include "cam/location/locator.h"
#include "cam/plan/job_context.h"

namespace patchmill {

// The figures of every region, by id. step_min and step_max of a reachable region: the smallest and the
// largest distance between neighbouring ball centres, measured on the centre surface across the feed of the
// region's strategy, that leaves exactly its scallop (CenterStep). otherwise_share: the share of the area
// that is steep in a gentle region or gentle in a steep one, where merging left it in the region and its
// strategy is kAuto. selected_share: the share of the area that the operation selects (IsWanted). All are
// taken at up to about 200,000 points, spread over the regions in patch parameters. Points where the ball
// does not fit (kappa R >= 1) do not count for the steps. A region without points has steps of 0 and is
// selected as a whole. CANCELLED, DEADLINE_EXCEEDED from the run.
absl::StatusOr<std::vector<RegionFigures>> MeasureRegions(const JobContext& context, const RegionMap& map,
                                                          const std::vector<RegionChoice>& choices);

// mm: no passes of this finish are shorter together. The integral of the area of the centre surface over the
// widest step at each place, which is CenterStep across the most convex direction. It runs over the reachable
// surface that is selected and not skipped, without places that forced passes leave as STRATEGY, and once
// over patches that coincide. A millimetre of a pass finishes no more than the widest step beside it, hence
// the bound. A vertical face counts from the side on which the ball finds room, found at a few places of each
// piece in a region; else from the side with the shorter passes. The same points as MeasureRegions.
// `locator`: of resolved.plan_radius. CANCELLED,
// DEADLINE_EXCEEDED from the run.
absl::StatusOr<double> LeastCutLength(const JobContext& context, const Locator& locator, const RegionMap& map,
                                      const std::vector<RegionChoice>& choices);

}  // namespace patchmill
