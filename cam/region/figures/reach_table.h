// Measures how much of the surface is unreachable for each of several balls. It shows which tool to buy.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

inline constexpr std::size_t kMaxReachRadii = 64;  // radii in one table

struct ReachTableParams {
  // mm, > 0, strictly increasing, at most kMaxReachRadii of them. Each includes the stock to leave.
  std::vector<double> radii;
  double tolerance = 0.01;      // mm, the whole error budget; below half of the smallest radius
  double floor_z = -kInfinity;  // mm, lowest tip
};

// Areas of the surface, mm^2, by the rule of [regions, section 6]. Unreachable areas count for all reasons.
struct ReachTableResult {
  double area = 0.0;                // the whole surface
  std::vector<double> unreachable;  // [radius]: unreachable with this ball; not decreasing
  std::vector<double> largest;      // [radius]: this is the largest of the balls that reaches the area
};

// For each radius the surface is split along the limits of reach, as for the region map (zero_mesh.h). Cells
// are at most 0.6 radii wide, or 0.005 of the box's diagonal if that is more. Limits are known to 0.01 mm or
// 0.01 radii, whichever is less. So the areas are those of the map, except that loops narrower than half a
// cell may be missed. Unreachable areas rise with the radius [regions T14]. Cost: a tenth of a second per
// radius on an ordinary part. INVALID_ARGUMENT if radii or tolerance are out of range. CANCELLED and
// DEADLINE_EXCEEDED from `run`.
absl::StatusOr<ReachTableResult> ReachTable(const Surface& surface, const ReachTableParams& params,
                                            const RunContext& run);

}  // namespace patchmill
