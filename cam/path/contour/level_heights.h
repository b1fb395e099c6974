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

// mm: how near to the places that need it a partial level runs. `gap` is the gap to its neighbours.
inline double ReachOfSpot(double spacing, double gap) { return 1.5 * spacing + 2.0 * gap; }

// Flat step-overs: a longer gap between two levels has no surface in it.
inline constexpr double kMostGap = 2.3;

// More levels than this are refused, with LimitPassedError of "contour_level_count".
inline constexpr std::size_t kMostLevels = 50000;
absl::Status TooManyLevels(double count);

struct HeightParams {
  double radius = 3.0;     // mm, of the ball
  double flat = 0.5;       // mm: the step over a plane
  double smallest = 0.1;   // mm: smaller needs count as this
  double wide = kWideGap;  // factor by which gaps may exceed their needs throughout: WideGap
  // The lowest level, which exists already and belongs to the group below (level_groups.h).
  std::optional<double> base_level = std::nullopt;
};

struct LevelPlan {
  std::vector<double> heights;  // rising, with the base level
  double length = 0.0;          // mm, about: of all levels, partial ones too, for comparing trials
};

// Returns centre heights, rising. Where faces end on a common height (floors, flats, level rims) a level lies
// exactly there. Between two such heights the number and the shares of the gaps are chosen so that full
// levels, and partial levels where the surface needs less than their gap (PartsOfGap), are shortest together.
// An end without a level costs the same for every choice. The gaps are equal in units of a step that rules at
// each height: the one of least length there (CheapestStep), or the 2, 10, 25 or 50 % quantile of the needs.
// For each rule numbers of gaps up to a tenth fewer or more than its steps require are tried (at most 41). A
// gap wider than its need by less than kWideGap gets no partial level; beyond `wide` it counts for a tenth
// more. Cost O(n log n) in the samples times the eighths of a flat step-over that each stands for, and their
// number for each of at most 205 trials, in parallel. Deterministic. Errors: RESOURCE_EXHAUSTED beyond
// kMostLevels; CANCELLED or DEADLINE_EXCEEDED from `run`.
absl::StatusOr<LevelPlan> LevelHeights(const ContourArea& contour_area, const HeightParams& params,
                                       const RunContext& run);

}  // namespace patchmill
