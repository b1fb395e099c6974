// Finds a quicker order of stops, some of which must come before others.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "core/base/run_context.h"
#include "core/base/vec.h"

namespace patchmill {

struct Stop {
  Vec3 enter, leave;                // mm
  std::vector<std::size_t> before;  // the stops that must come before it
};

using TravelTime = std::function<double(const Vec3& from, const Vec3& to)>;  // s

// Improves `order`, in which each stop comes after those that must come before it (Or-opt). Runs of up to
// three stops are moved to where this saves most time, never past stops that must come before or after them,
// until no move saves time. `from` is the place of the tool. Deterministic. Cost: O(n w) per sweep, where w
// <= 400 is the number of places to which a run may move; at most 20 sweeps. Stops when cancelled.
std::vector<std::size_t> ShortenOrder(const std::vector<Stop>& stops, std::vector<std::size_t> order,
                                      const Vec3& from, const TravelTime& travel, const RunContext& run);

}  // namespace patchmill
