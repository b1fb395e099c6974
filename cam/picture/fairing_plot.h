// Draws a curve before and after fairing with its curvature comb, as SVG.
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

// The view is along the axis in which the curve is least extended, with one scale for both curves. The teeth
// of the comb point away from the centre of curvature. Their length is proportional to the curvature of the
// projection, with one scale for both, and at most a quarter of a panel's height. Each comb has about
// kMaxCombTeeth teeth at most.
inline constexpr int kMaxCombTeeth = 3000;
std::string DrawFairing(const FairingPlot& plot);

}  // namespace patchmill
