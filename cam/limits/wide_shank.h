// A shank that is wider than the ball: an upright cylinder about the tool's axis without an upper end. What
// the planner and the judge mean by it.
#pragma once

#include <optional>

namespace patchmill {

struct Tool;

struct WideShank {
  double radius = 0.0;  // mm
  double rise = 0.0;    // mm, from the ball's centre up to where it begins; negative for flutes below it
};

// None where it is no wider than the ball: the ball's own sweep upward holds it then.
std::optional<WideShank> WideShankOf(const Tool& tool);

// The wider one of ball and shank, mm.
double WidestRadius(const Tool& tool);

}  // namespace patchmill
