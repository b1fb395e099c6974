// A shank that is wider than the ball: a vertical cylinder around the tool's axis without an upper end.
// Planner and verifier share this definition.
#pragma once

#include <optional>

namespace patchmill {

struct Tool;

struct WideShank {
  double radius = 0.0;  // mm
  double rise = 0.0;    // mm, from the ball's centre up to its lower end; may be negative
};

// nullopt if the shank is no wider than the ball. The upward sweep of the ball then contains it.
std::optional<WideShank> WideShankOf(const Tool& tool);

// The larger radius of ball and shank, mm.
double WidestRadius(const Tool& tool);

}  // namespace patchmill
