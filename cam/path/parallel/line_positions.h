// Where the zig-zag lines lie: as far apart as the scallop allows, with the first and the last at the limits
// of what is wanted.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/path/parallel/line_clip.h"
#include "cam/toolpath/segment_tree.h"
#include "core/base/run_context.h"

namespace patchmill {

// The range in which lines are looked for, in their frame.
struct FrameExtent {
  Interval t, y;
};
// Returns the extent of everything that straight lines can touch: the leaves' bounds plus `margin` (a ball
// radius).
FrameExtent ExtentOfParallels(const Surface& surface, double angle, double margin);

// A band: full lines over a range of y in which every row has something wanted.
struct LineBand {
  Interval y;                     // limits of what is wanted, less the part that passes beside it finish
  std::vector<double> positions;  // rising, the first and the last at the limits
};

// Returns the bands, rising. Rows lie 1.5 flat step-overs apart; between rows whose steps differ by more than
// 3 % there are more, down to 0.15. Rows are sampled every 2 flat step-overs. The step of each is the one
// that makes lines and the partial lines at narrow spots shortest together (CheapestStep). Among the numbers
// of gaps that keep these steps the one with the least length is taken. The limits of bands are found to 1e-3
// of the flat step-over, at the sampling's resolution along the lines. `beside` (null: none) holds passes
// beside the area. Where they run along a limit of circular lines, nearer to all of it than the step needed
// there, the line at the limit moves away from them up to that step, if that saves a line.
absl::StatusOr<std::vector<LineBand>> LinePositions(const LineProber& prober, const FrameExtent& extent,
                                                    const SegmentTree* beside, const RunContext& run);

}  // namespace patchmill
