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
  std::vector<Interval> where;  // of t, rising and disjoint; elsewhere the line would repeat a limit of its
                                // band
};

// Returns the full lines of a band, rising; the first and the last are its limits. Along straight lines the
// narrowest step of a row rules (or partial lines fill in). Lines that share the way between the limits by
// the density that each place needs leave the same scallop with less length. Lines turn by at most max_bend
// (rad) where anything is wanted. They are straight, at band.positions, if they cannot keep that limit, if
// the estimate saves less than 4 %, or if the lines with all that fills their gaps (FillGap; of more than 64
// gaps 24 are measured) save less than 1 %. Knots lie a ball radius apart. Needs are sampled three times as
// densely, first along straight rows, then along the bent lines. Needs that neighbours still do not meet are
// left to partial lines.
absl::StatusOr<std::vector<BentLine>> BendLines(const LineProber& prober, const Interval& range,
                                                const LineBand& band, double max_bend, const RunContext& run);

}  // namespace patchmill
