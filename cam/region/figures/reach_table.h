// How much of the surface stays out of reach for each of several balls: which tool to buy.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

inline constexpr std::size_t kMaxReachRadii = 64;

struct ReachTableParams {
  // mm, > 0, strictly increasing, at most kMaxReachRadii; stock to leave counted in.
  std::vector<double> radii;
  double tolerance = 0.01;      // mm: the whole budget; below half of the smallest radius
  double floor_z = -kInfinity;  // mm, lowest tip
};

// Areas of the surface, mm^2, by the rule of [regions, section 6], all reasons; one for each radius.
struct ReachTableResult {
  double area = 0.0;                // of all of it
  std::vector<double> unreachable;  // with this ball; not decreasing
  std::vector<double> largest;      // for which this is the largest of the balls that reaches it
};

// For each radius the surface is split along the limits of reach as the region map is (zero_mesh.h), in cells
// of 0.6 radii or 0.005 of the box's diagonal, and limits are known to 0.01 mm or 0.01 radii: the areas are
// those of the map, but for loops narrower than half a cell, which may be missed. A ball inside a free one
// that touches the same point is free, and so is its shank and its tip is higher: areas rise with the radius.
// Cost: a tenth of a second a radius on an ordinary part. INVALID_ARGUMENT for radii or a tolerance out of
// range; CANCELLED, DEADLINE_EXCEEDED from `run`.
absl::StatusOr<ReachTableResult> ReachTable(const Surface& surface, const ReachTableParams& params,
                                            const RunContext& run);

}  // namespace patchmill
