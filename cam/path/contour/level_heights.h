// The heights at which the full levels of contours lie.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/path/contour/contour_samples.h"
#include "cam/path/stepover/step_over.h"
#include "core/base/run_context.h"

namespace patchmill {

// Returns how far (mm) a partial level runs beyond the samples that need it. `spacing` (mm) is that of the
// samples, `gap` (mm) the gap between the partial level and its neighbours.
inline double ReachOfSpot(double spacing, double gap) { return 1.5 * spacing + 2.0 * gap; }

// Flat step-overs: a longer gap between two levels means that there is no steep surface in between.
inline constexpr double kMostGap = 2.3;

// More levels than this are refused, with LimitPassedError of "contour_level_count".
inline constexpr std::size_t kMostLevels = 50000;
absl::Status TooManyLevels(double count);

struct HeightParams {
  double radius = 3.0;     // mm, of the ball
  double flat = 0.5;       // mm: the step over a plane
  double smallest = 0.1;   // mm: smaller needed z-steps count as this
  double wide = kWideGap;  // factor by which gaps may exceed their needs throughout: WideGap
  // The lowest level, which exists already and belongs to the group below (level_groups.h).
  std::optional<double> base_level = std::nullopt;
};

struct LevelPlan {
  std::vector<double> heights;  // rising, with the base level
  double length = 0.0;          // mm, estimated length of all levels, partial ones too, to compare plans
};

// Returns the heights of the full levels [spacing, section 4].
//
// Where the lower ends of faces lie at a common height (floors, flats, level rims) a level lies exactly
// there. Between two such fixed heights the plan with the least estimated length of full and partial levels
// is chosen among at most 205 trials. A trial is one of five rules and one of at most 41 numbers of gaps. The
// rule gives a z-step for each height: that of least length there (CheapestStep), or the 2, 10, 25 or 50 %
// quantile of the needed z-steps. All gaps of a trial are equal in units of this z-step. The numbers of gaps
// differ by up to a tenth from what the rule requires. In the estimate a gap gets a partial level where it is
// wider than needed by more than kWideGap; where it is wider by more than `wide`, its length counts for a
// tenth more, since rest passes may follow.
//
// Cost: O(n log n) for n samples, each counted once for every eighth of a flat step-over that it stands for,
// and O(n) for each trial, in parallel. Deterministic. Errors: RESOURCE_EXHAUSTED beyond kMostLevels;
// CANCELLED or DEADLINE_EXCEEDED from `run`.
absl::StatusOr<LevelPlan> LevelHeights(const ContourArea& contour_area, const HeightParams& params,
                                       const RunContext& run);

}  // namespace patchmill
