// What lies between two zig-zag lines whose gap is too wide for the ground somewhere.
#pragma once

#include <vector>

#include "cam/path/parallel/line_clip.h"

namespace patchmill {

// Cuts the gap between two lines into as many parts as it needs within these t, stretch by stretch; the new
// lines may find that they need more. Appends them to `out`; means nothing once the prober is cancelled.
void FillGap(const LineProber& prober, const ClippedLine& a, const ClippedLine& b, const Interval& within,
             double min_step, std::vector<ClippedLine>& out);

}  // namespace patchmill
