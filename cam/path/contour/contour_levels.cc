#include "cam/path/contour/contour_levels.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "cam/path/contour/level_heights.h"
#include "cam/path/stepover/step_over.h"
#include "core/base/status.h"

namespace patchmill {

HeightParams HeightParamsOf(const ContourParams& params, double radius) {
  const double flat = CenterStep(radius, params.pass.scallop, 0.0);
  return {.radius = radius,
          .flat = flat,
          .smallest = std::max(1e-6, params.pass.min_step_fraction * flat),
          .wide = WideGap(params.pass.scallop, params.pass.chord_tolerance)};
}

absl::StatusOr<std::vector<PlannedLevel>> PlanLevels(const ContourArea& contour_area,
                                                     const ContourParams& params, double radius,
                                                     std::optional<double> base_level,
                                                     const RunContext& run) {
  std::vector<PlannedLevel> levels;
  if (contour_area.samples.empty()) return levels;
  HeightParams height_params = HeightParamsOf(params, radius);
  height_params.base_level = base_level;
  const double flat = height_params.flat, smallest = height_params.smallest;
  PM_ASSIGN_OR_RETURN(LevelPlan plan, LevelHeights(contour_area, height_params, run));
  std::vector<double>& heights = plan.heights;
  const double floor = params.pass.floor_z + radius;
  for (double& z : heights) z = std::max(z, floor);
  std::sort(heights.begin(), heights.end(), std::greater<>());
  heights.erase(std::unique(heights.begin(), heights.end(),
                            [&](double a, double b) { return a - b < 1e-3 * smallest; }),
                heights.end());

  // Add partial levels at samples that need a smaller gap than they got.
  std::vector<ContourSample> sorted = contour_area.samples;
  std::stable_sort(sorted.begin(), sorted.end(), [](const ContourSample& a, const ContourSample& b) {
    return a.center.z() > b.center.z();
  });
  std::size_t next = 0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double z = heights[i];
    if (base_level && i + 1 == heights.size()) break;
    const double gap = i + 1 < heights.size() ? z - heights[i + 1] : i > 0 ? heights[i - 1] - z : flat;
    levels.push_back({z, std::min(gap, kMostGap * flat), false, {}});
    if (i + 1 == heights.size()) break;
    while (next < sorted.size() && sorted[next].center.z() > z) ++next;
    std::map<int, std::vector<Vec3>> spots;  // by the number of parts into which the gap is divided there
    for (std::size_t k = next; k < sorted.size() && sorted[k].center.z() > heights[i + 1]; ++k) {
      if (gap > kMostGap * flat) continue;
      const int parts = PartsOfGap(gap, kWideGap * sorted[k].step, smallest);
      if (parts > 1) spots[parts].push_back(sorted[k].center);
    }
    const std::size_t first = levels.size();
    for (const auto& [parts, centers] : spots) {
      for (int k = 1; k < parts; ++k) {
        const double below = gap * k / parts;
        const auto same = std::find_if(levels.begin() + static_cast<std::ptrdiff_t>(first), levels.end(),
                                       [&](const PlannedLevel& l) { return l.z == z - below; });
        if (same == levels.end()) {
          levels.push_back({z - below, gap / parts, true, centers});
        } else {
          same->spots.insert(same->spots.end(), centers.begin(), centers.end());
        }
      }
    }
    std::sort(levels.begin() + static_cast<std::ptrdiff_t>(first), levels.end(),
              [](const PlannedLevel& a, const PlannedLevel& b) { return a.z > b.z; });
  }
  return levels;
}

}  // namespace patchmill
