// Zig-zag lines that bend a little, so that their distance follows the step that the scallop allows.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/path/parallel/line_positions.h"
#include "cam/path/parallel/line_shape.h"
#include "core/base/run_context.h"

namespace patchmill {

struct BentLine {
  LineShape line;
  // Intervals of t, rising and disjoint, on which the line is cut. Elsewhere it lies on a limit of its band,
  // where another line runs.
  std::vector<Interval> where;
};

// Returns the full lines of a band, rising in y; the first and the last are the limits of the band. A
// straight line must keep the narrowest step of its whole length, or partial lines must fill in. Bent lines
// divide the distance between the limits at each t in proportion to the density of lines needed there, and
// leave the same scallop with less length. Where a line is wanted it turns from the straight direction by at
// most max_bend (rad).
//
// The lines are straight, at band.positions, in three cases: if bent ones would turn by more; if the estimate
// saves less than 4 %; or if the lines together with the partial lines in their gaps (FillGap) save less than
// 1 %. If there are more than 64 gaps, 24 of them are measured. Knots lie a ball radius apart. The needed
// steps are sampled three times as densely, first along straight rows, then along the bent lines. Where bent
// lines are still too far apart, partial lines follow.
absl::StatusOr<std::vector<BentLine>> BendLines(const LineProber& prober, const Interval& range,
                                                const LineBand& band, double max_bend, const RunContext& run);

}  // namespace patchmill
