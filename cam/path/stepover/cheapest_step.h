// The step between full passes that makes them and the partial ones between them shortest together.
#pragma once

#include <vector>

namespace patchmill {

// A stretch of ground that passes run over.
struct StepNeed {
  double step = 0.0;    // mm: its passes may lie this far apart, at most; may be infinite
  double weight = 1.0;  // its length along the passes, in any unit, the same for all
};

inline constexpr double kRunCost = 2.0;  // ball radii: what the way to one run more costs

// mm, in [least, most]: the step at which the full passes and those added where the step is cut into parts
// (PartsOfGap) have the least length, among the needs' own steps at 17 shares of their weight. Sorts the
// needs; none: `most`. Cost O(n log n).
double CheapestStep(std::vector<StepNeed>& needs, double least, double most);

}  // namespace patchmill
