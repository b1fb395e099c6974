// P3: rapids through the stock.
#pragma once

#include "cam/verify/extreme.h"
#include "cam/verify/segment_tree.h"

namespace patchmill {

// Places where the surface lies nearer than `clear` mm (ball radius + allowance) to the upward swept rapids
// of `tree` (Metric::kSwept): one Extreme per root cell, value = how much nearer, largest first. Cells that
// are not proven clear are halved down to 0.02 mm; what is left then is not reported.
absl::StatusOr<std::vector<Extreme>> FindRapidsInStock(const Surface& surface,
                                                       const std::vector<CellRect>& roots,
                                                       const SegmentTree& tree, double clear,
                                                       const RunContext& run);

}  // namespace patchmill
