// Turns passes round where the tool would otherwise run back over what it has just cut.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/link/link_moves.h"
#include "cam/toolpath/cutter_path.h"
#include "core/base/run_context.h"

namespace patchmill {

// `passes` come in the order in which they are cut, which stays. An open pass that may run both ways and is
// no contour is turned round if the links to it and from it (those of LinkTo) cost less then (CostOf). Only
// passes whose straight links would be shorter, too, are looked at. These are few: mostly parts of a line
// that is cut in two, and what is left of a line beside others. Each pass is looked at once, in the order
// of the cut. Deterministic. Cost: four links for each pass that is looked at. CANCELLED and
// DEADLINE_EXCEEDED from `run`.
absl::StatusOr<std::vector<CutterPath>> WithPassesTurned(const LinkMaker& maker,
                                                         std::vector<CutterPath> passes,
                                                         const RunContext& run);

}  // namespace patchmill
