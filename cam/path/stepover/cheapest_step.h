// The step between full passes at which full and partial passes together are shortest.
#pragma once

#include <vector>

namespace patchmill {

// A part of the surface that passes run over, and the step that it needs.
struct StepNeed {
  double step = 0.0;    // mm: its passes may lie at most this far apart; may be infinite
  double weight = 1.0;  // its length along the passes, in any unit that is the same for all
};

inline constexpr double kRunCost =
    2.0;  // ball radii of cutting length: what the way to one more partial pass costs

// Returns the step (mm, in [least, most]) at which the full passes and the passes added in divided gaps
// (PartsOfGap) have the least total length. The candidates are the steps of the needs at 17 quantiles of
// their weight. Sorts the needs. Without needs the result is `most`. Cost O(n log n).
double CheapestStep(std::vector<StepNeed>& needs, double least, double most);

}  // namespace patchmill
