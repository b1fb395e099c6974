// Where ground that hangs together parts upwards: a spout beside a body, two summits above a saddle.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/path/contour/contour_samples.h"

namespace patchmill {

// What rises from `from`, a sample of the ground that it joins at the height `foot` (mm, of centres), and
// does not hang together with that above.
struct LevelBranch {
  std::size_t from = 0;
  double base_level = 0.0;
  double area = 0.0;                 // mm2, with the branches on it
  std::vector<std::size_t> samples;  // without those of the branches on it
};

struct BranchParams {
  double reach = 1.0, rise = 3.0;  // mm
};

// The smaller side of every fork of which both rise at least `rise` above it, smaller ones first, so that
// those on a branch come before it. Samples hang together where they are neighbours of one piece, or where
// their contacts or their centres lie within `reach` of each other, at most in cubes of that size next to
// each other: forks that are narrower are not seen. Those of different `sets`, one for each sample, never
// do. Cost O(n log n); CANCELLED or DEADLINE_EXCEEDED from
// `run`.
absl::StatusOr<std::vector<LevelBranch>> FindBranches(const ContourArea& contour_area,
                                                      std::span<const std::size_t> sets,
                                                      const BranchParams& params, const RunContext& run);

}  // namespace patchmill
