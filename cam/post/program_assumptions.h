// What a verdict on a program assumes of the control and its set-up. Each assumption is a warning with the
// line where it first counts, and each code occurs once.
#pragma once

#include <string>
#include <vector>

#include "core/base/diagnostic.h"

namespace patchmill {

// The codes of the assumptions among some findings, in their order, each once. They are: UNITS_ASSUMED (mm,
// of coordinates or of an F), DISTANCE_MODE_ASSUMED (G90), PLANE_ASSUMED (G17, of an arc), ARC_MODE_ASSUMED
// (G91.1), WORK_OFFSET_ASSUMED (the one of the set-up is active), LENGTH_OFFSET_ASSUMED (set before),
// LENGTH_OFFSET_OF_OTHER_TOOL (H is not T), PATH_MODE_ASSUMED (as a G64 without a limit, or exact if the
// request says so), REFERENCE_ASSUMED (the point of G28 and G30 is above everything), MACHINE_Z_ASSUMED (so
// is a machine Z below the dialect's machine_top), TOOL_CHANGE_ASSUMED (it happens above everything),
// TOOL_ASSUMED (the one before the first tool change), CYCLE_END_ASSUMED (G98), SPINDLE_REVERSED (a left-hand
// cutter), ROTARY_ASSUMED (rotary axes stand at 0), TOOL_NAME_ASSUMED (a tool with a name is that of the
// set-up), WORD_ASSUMED (a word of the machine's builder), CONTROL_DEVIATION_ASSUMED and WORD_EXPLAINED (what
// the user says of the control).
std::vector<std::string> AssumptionCodes(const Diagnostics& findings);

}  // namespace patchmill
