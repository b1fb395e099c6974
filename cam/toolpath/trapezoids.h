// Speeds that change evenly along a path: over time they are trapezoids.
#pragma once

#include <span>
#include <vector>

namespace patchmill {

struct Stretch {
  double length = 0.0;        // mm, > 0
  double speed = 0.0;         // mm/s, the greatest along it
  double acceleration = 0.0;  // mm/s^2 along the path, the greatest
};

// Returns the time of each stretch, s. `corners` has the greatest speed, mm/s, at the start of each stretch
// and one more at the end of the last. Neither stretch beside a corner is driven faster than it allows. Cost
// O(n).
std::vector<double> TrapezoidTimes(std::span<const Stretch> stretches, std::vector<double> corners);

}  // namespace patchmill
