// Moves short border, pencil and rest passes to places between other passes where they are cut sooner.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/link/link_moves.h"
#include "cam/toolpath/cutter_path.h"
#include "core/base/run_context.h"

namespace patchmill {

// `passes` come in the order in which they would be cut. A pass is moved if it is an open border, pencil or
// rest pass, no longer than MaxLinkLength(params), and reached with a rapid. It goes between two neighbours
// that are no contours, and may be reversed. The place is the one where the links to and from the pass (those
// of LinkTo, not estimates) cost least (CostOf), if that is less than at its present place. The nearest few
// places are tried for each pass, and the first 256 such passes are looked at. Other passes keep their order.
// Deterministic. CANCELLED and DEADLINE_EXCEEDED from `run`.
absl::StatusOr<std::vector<CutterPath>> InsertPasses(const LinkMaker& maker, std::vector<CutterPath> passes,
                                                     const LinkParams& params, const RunContext& run);

}  // namespace patchmill
