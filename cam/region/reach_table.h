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

// Areas of the surface, mm^2, by the rule of docs/reach.md, all reasons; one for each radius.
struct ReachTableResult {
  double area = 0.0;                // of all of it
  std::vector<double> unreachable;  // with this ball; not decreasing
  std::vector<double> largest;      // for which this is the largest of the balls that reaches it
};

// A ball inside a free one that touches the same point is free, and so is its shank and its tip is higher:
// every point has one largest radius and is asked for it by halving the list. Cells of the surface are
// quartered where their points differ, down to about 3 % of the smallest radius or 1/256 of a piece: areas
// are right to about that times the length of the limits. Cost: some 10 us a cell. INVALID_ARGUMENT for radii
// or a tolerance out of range; CANCELLED, DEADLINE_EXCEEDED from `run`.
absl::StatusOr<ReachTableResult> ReachTable(const Surface& surface, const ReachTableParams& params,
                                            const RunContext& run);

}  // namespace patchmill
