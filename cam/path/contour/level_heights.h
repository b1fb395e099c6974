// At which heights the full levels of contours lie.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/path/contour/contour_samples.h"
#include "cam/path/stepover/step_over.h"
#include "core/base/run_context.h"

namespace patchmill {

// mm: how near to the places that need it a partial level runs; `gap`: to its neighbours.
inline double ReachOfSpot(double spacing, double gap) { return 1.5 * spacing + 2.0 * gap; }

// Flat steps: a longer gap between two levels has no ground in it.
inline constexpr double kMostGap = 2.3;

// More levels than this are refused: LimitPassedError of "contour_level_count".
inline constexpr std::size_t kMostLevels = 50000;
absl::Status TooManyLevels(double count);

struct HeightParams {
  double radius = 3.0;     // mm, of the ball
  double flat = 0.5;       // mm: the step over a plane
  double smallest = 0.1;   // mm: needs below it count as this
  double wide = kWideGap;  // how much wider than their needs gaps may be throughout: WideGap
  // A level lies here already, at the foot of the ground: it is the lowest, and others' (level_groups.h).
  std::optional<double> base_level = std::nullopt;
};

struct LevelPlan {
  std::vector<double> heights;  // rising, the foot among them
  double length = 0.0;          // mm, about: of all levels, partial ones too, as trials are compared
};

// Centre heights, rising: where faces end on a common level (floors, flats, level rims) exactly there, and
// between these so many, and so shared out, that they and the partial levels where the ground needs less than
// their gap (PartsOfGap) are shortest; what an end without a level needs besides counts alike, whoever cuts
// it. Shared out in units of a step that rules at each height: the one with the least length there
// (CheapestStep), or what 2, 10, 25 or 50 % of the ground need at most; of each as many as its steps ask for,
// up to a tenth fewer or more (41 numbers of them at most). Gaps wider than their need by kWideGap get none;
// beyond `wide` they count for a tenth more. Cost O(n log n) in the samples times the eighths of a flat
// step that each stands for, and their number for each of 205 trials at most, side by side; deterministic.
// RESOURCE_EXHAUSTED beyond kMostLevels; CANCELLED or DEADLINE_EXCEEDED from `run`.
absl::StatusOr<LevelPlan> LevelHeights(const ContourArea& contour_area, const HeightParams& params,
                                       const RunContext& run);

}  // namespace patchmill
