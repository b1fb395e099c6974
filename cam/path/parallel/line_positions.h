// Where the zig-zag lines lie: as far apart as the scallop allows, the first and the last at the limits of
// what is wanted.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/path/parallel/line_clip.h"
#include "cam/toolpath/segment_tree.h"
#include "core/base/run_context.h"

namespace patchmill {

// Where lines are looked for, in their frame.
struct FrameExtent {
  Interval t, y;
};
// Of everything that straight lines can touch: bounds of the leaves plus the margin (a ball radius).
FrameExtent ExtentOfParallels(const Surface& surface, double angle, double margin);

// Full lines over a stretch of y in which every row has something wanted.
struct LineBand {
  Interval y;                     // limits of what is wanted, less what passes beside it take
  std::vector<double> positions;  // rising, the first and the last at the limits
};

// Bands, rising. Rows 1.5 flat steps apart, and between those whose steps differ by more than 3 % down to
// 0.15, are sampled every 2 flat steps; at each the step is the one that makes lines plus the partial lines
// at narrow spots shortest (CheapestStep); of the whole numbers of gaps that are as narrow, the one that
// does. The limits of bands are found to 1e-3 of the flat step at the sampling's resolution along the lines.
// Where passes of `beside` (null: none) run along a limit of round lines, nearer to all of it than the step
// needed there, the line at the limit moves away from them up to that step, if that saves a line.
absl::StatusOr<std::vector<LineBand>> LinePositions(const LineProber& prober, const FrameExtent& extent,
                                                    double min_step, const SegmentTree* beside,
                                                    const RunContext& run);

}  // namespace patchmill
