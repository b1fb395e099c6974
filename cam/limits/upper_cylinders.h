// The tool above its ball: a shank that is wider than the ball, and the holder. Both are vertical cylinders
// around the tool's axis without an upper end. Planner and verifier share this definition.
#pragma once

#include <vector>

namespace patchmill {

struct Tool;

enum class UpperPart { kShank, kHolder };
constexpr UpperPart LastOf(UpperPart) { return UpperPart::kHolder; }

const char* Name(UpperPart part);  // "shank", "holder"

struct UpperCylinder {
  double radius = 0.0;  // mm
  double rise = 0.0;    // mm, from the ball's centre up to its lower end; may be negative
  UpperPart part = UpperPart::kShank;
};

// Cylinders replace a cone of the holder as stairs. A step is at most kHolderStep (mm) wide, or wider where a
// cone would have more than kMostHolderSteps of them.
inline constexpr double kHolderStep = 0.25;
inline constexpr int kMostHolderSteps = 40;

// The shank, if it is wider than the ball, then the cylinders of the holder, from the lowest on, with its
// clearance around and below. Each is wider than those before it: the upward sweep of a lower one contains
// all others. A cone of the holder is replaced by cylinders around it. Empty if the upward sweep of the ball
// contains everything.
std::vector<UpperCylinder> UpperCylindersOf(const Tool& tool);

// The larger radius of ball and shank, mm.
double WidestRadius(const Tool& tool);

}  // namespace patchmill
