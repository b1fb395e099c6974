// Fills the space between two zig-zag lines whose gap is too wide for the surface somewhere.
#pragma once

#include <vector>

#include "cam/path/parallel/line_clip.h"

namespace patchmill {

// Divides the gap between two lines within this range of t, stretch by stretch, into as many parts as it
// needs. The new lines may need more. Appends them to `out`. The result is meaningless once the prober is
// cancelled.
void FillGap(const LineProber& prober, const ClippedLine& a, const ClippedLine& b, const Interval& within,
             std::vector<ClippedLine>& out);

}  // namespace patchmill
