// A curve before and after fairing with its curvature comb, as SVG.
#pragma once

#include <string>
#include <vector>

#include "core/fairing/beam.h"

namespace patchmill {

struct FairingPlot {
  const Beam* before = nullptr;  // required
  const Beam* after = nullptr;   // required
  std::string title;
  std::vector<std::string> notes;  // lines under the title
};

// Seen along the axis in which the curve is least extended, both in the same scale; the comb's teeth point
// away from the centre of curvature, as long as the curvature of the projection, in one scale for both, cut
// off at a quarter of the picture's height. At most kMaxCombTeeth teeth each.
inline constexpr int kMaxCombTeeth = 3000;
std::string DrawFairing(const FairingPlot& plot);

}  // namespace patchmill
