// Finds where a connected area forks upwards: a spout beside a body, two summits above a saddle.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/path/contour/contour_samples.h"

namespace patchmill {

// A branch of a connected steep area. At the height `base_level` (mm, of the centre) it joins the rest of the
// area, to which the sample `from` belongs. Above that height the two are not connected.
struct LevelBranch {
  std::size_t from = 0;
  double base_level = 0.0;
  double area = 0.0;                 // mm2, including the branches that stand on this one
  std::vector<std::size_t> samples;  // without the samples of branches that stand on this one
};

// `reach`: samples this near to each other are connected. `rise`: both sides of a fork rise at least so much
// above it.
struct BranchParams {
  double reach = 1.0, rise = 3.0;  // mm
};

// Returns the smaller side of every fork of which both sides rise at least `rise` above it. Smaller branches
// come first, so that the branches on a branch come before it. Samples are connected where they are
// neighbours on one piece, or where their contacts or their centres lie within `reach` of each other. The
// latter is decided by cubes of that size that touch, so narrower forks are not seen. Samples of different
// `sets` (one entry for each sample) are never connected. Cost O(n log n). Errors: CANCELLED or
// DEADLINE_EXCEEDED from `run`.
absl::StatusOr<std::vector<LevelBranch>> FindBranches(const ContourArea& contour_area,
                                                      std::span<const std::size_t> sets,
                                                      const BranchParams& params, const RunContext& run);

}  // namespace patchmill
