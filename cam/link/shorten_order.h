// A shorter way through stops of which some must come before others.
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

// `order`, which keeps what must come before, with runs of up to three stops moved to where that saves most
// time, never past what must come before or after them, until nothing saves any (Or-opt). `from`: where the
// tool is. Deterministic. Cost per sweep O(n w), w: how far stops may move, 400 places at most; 20 sweeps at
// most. Stops when cancelled.
std::vector<std::size_t> ShortenOrder(const std::vector<Stop>& stops, std::vector<std::size_t> order,
                                      const Vec3& from, const TravelTime& travel, const RunContext& run);

}  // namespace patchmill
