#include "cam/limits/upper_cylinders.h"

#include <algorithm>
#include <cmath>

#include "cam/tool/tool.h"

namespace patchmill {
namespace {

// Adds cylinders around one segment of the holder whose lower end is at `bottom` (mm above the ball's
// centre).
void AddSegment(const HolderSegment& segment, double clearance, double bottom, double widest,
                std::vector<UpperCylinder>& cylinders) {
  const double low = 0.5 * segment.lower_diameter, high = 0.5 * segment.upper_diameter;
  const double growth = std::max(0.0, high - low);
  const int steps = std::clamp(static_cast<int>(std::ceil(growth / kHolderStep)), 1, kMostHolderSteps);
  for (int k = 0; k < steps; ++k) {
    const double radius = low + growth * (k + 1) / steps + clearance;
    if (radius <= std::max(widest, cylinders.empty() ? 0.0 : cylinders.back().radius)) continue;
    cylinders.push_back({radius, bottom + segment.length * k / steps - clearance, UpperPart::kHolder});
  }
}

}  // namespace

const char* Name(UpperPart part) {
  switch (part) {
    case UpperPart::kShank:
      return "shank";
    case UpperPart::kHolder:
      return "holder";
  }
  return "";
}

std::vector<UpperCylinder> UpperCylindersOf(const Tool& tool) {
  std::vector<UpperCylinder> cylinders;
  const double ball = BallRadius(tool), shank = 0.5 * tool.shank_diameter.value_or(0.0);
  if (shank > ball && tool.flute_length)
    cylinders.push_back({shank, *tool.flute_length - ball, UpperPart::kShank});
  if (tool.holder.empty() || !tool.stickout) return cylinders;
  double bottom = *tool.stickout - ball;
  for (const HolderSegment& segment : tool.holder) {
    AddSegment(segment, tool.holder_clearance, bottom, WidestRadius(tool), cylinders);
    bottom += segment.length;
  }
  return cylinders;
}

double WidestRadius(const Tool& tool) {
  return std::max(BallRadius(tool), 0.5 * tool.shank_diameter.value_or(0.0));
}

}  // namespace patchmill
