// Finds where zig-zag lines lie: as far apart as the scallop allows, with the first and the last at the
// limits of the area that is wanted.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/path/parallel/line_clip.h"
#include "cam/toolpath/segment_tree.h"
#include "core/base/run_context.h"

namespace patchmill {

// The range of t and y in which lines are sampled, in their frame (LineFrame).
struct FrameExtent {
  Interval t, y;
};
// Returns the extent of the surface in the frame of straight lines at `angle` (rad from +x), widened by
// `margin` (mm, a ball radius).
FrameExtent ExtentOfParallels(const Surface& surface, double angle, double margin);

// A band: a range of y in which every row of samples has a wanted place, and the full lines in it.
struct LineBand {
  Interval y;                     // mm: limits of the wanted area, less what passes beside the area finish
  std::vector<double> positions;  // mm, y of the lines: rising, the first and the last at the limits
};

// Returns the bands, rising in y [spacing, section 5]. The surface is sampled along rows 1.5 flat step-overs
// apart, every 2 flat step-overs along a row. Between rows whose steps differ by more than 3 % there are
// further rows, down to 0.15 flat step-overs apart. The step of a row is the one with which full lines and
// partial lines at narrow spots have the least total length (CheapestStep). Among the numbers of gaps that
// keep these steps the one with the least length is taken. The limits of bands are found to 1e-3 of the flat
// step-over in y; along the rows they are known only at the samples.
//
// `beside` (null: none) holds passes beside the area. It matters for circular lines only. If all places of a
// band's first or last line are nearer to these passes than the step needed there, the line moves away from
// them, up to that step, if that saves a line.
absl::StatusOr<std::vector<LineBand>> LinePositions(const LineProber& prober, const FrameExtent& extent,
                                                    const SegmentTree* beside, const RunContext& run);

}  // namespace patchmill
