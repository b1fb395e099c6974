// Siemens' cycles that set up a program: CYCLE832 and CYCLE800.
#pragma once

#include <string_view>

#include <absl/status/statusor.h>

#include "cam/post/gcode_modes.h"

namespace patchmill {

// CYCLE832(tolerance, kind, version). A tolerance of 0, and a kind that is missing, 0 or _OFF, leave to the
// machine by how much the control leaves the path. INVALID_ARGUMENT for variables.
absl::StatusOr<BlockModes> ReadCycle832(std::string_view arguments);

// CYCLE800(retraction, data set, rotation, mode, X0, Y0, Z0, A, B, C, X1, Y1, Z1, direction ...). Without
// arguments it ends a plane. A plane of zeros does not turn anything; with a retraction of 1 the tool goes up
// first, to a place of the machine. INVALID_ARGUMENT for other planes and retractions.
absl::StatusOr<BlockModes> ReadCycle800(std::string_view arguments);

}  // namespace patchmill
