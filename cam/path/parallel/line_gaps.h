// Fills the space between two zig-zag lines whose gap is too wide for the surface somewhere.
#pragma once

#include <vector>

#include "cam/path/parallel/line_clip.h"

namespace patchmill {

// Appends to `out` the partial lines between two neighbouring lines, within this range of t. Each stretch of
// the gap is divided into as many parts as the surface needs there. Gaps beside the new lines are divided
// again where they are still too wide. The result is meaningless once the prober is cancelled.
void FillGap(const LineProber& prober, const ClippedLine& a, const ClippedLine& b, const Interval& within,
             std::vector<ClippedLine>& out);

}  // namespace patchmill
