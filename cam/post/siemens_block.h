// Reads lines of Siemens programs (DIN/ISO with Siemens' own words) as blocks of the same modal groups as
// RS274. Source: SINUMERIK 840D sl / 828D, programming manuals "Fundamentals" and "Job planning".
#pragma once

#include <optional>
#include <string_view>

#include <absl/status/statusor.h>

#include "cam/post/gcode_modes.h"

namespace patchmill {

// The block of a line; absent for one that does nothing. Beside the words of RS274: SUPA (as G53), D (tool
// offset), G60 (exact stop), G700 and G710 (units of everything), G4 F (dwell, s), CYCLE832 (tolerance).
// INVALID_ARGUMENT (without the line number) for anything else: assignments, variables, calls, labels.
absl::StatusOr<std::optional<BlockModes>> ReadSiemensLine(std::string_view line, const Dialect& dialect);

}  // namespace patchmill
