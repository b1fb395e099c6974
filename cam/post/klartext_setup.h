// Lines of Heidenhain's conversational programs that set up a program: tool calls, cycles, planes and frames.
// Source: the user's manuals for conversational programming and for cycles of iTNC 530 and TNC 640.
#pragma once

#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/post/gcode_modes.h"

namespace patchmill {

// `words` are those of the whole line (klartext_words.h). INVALID_ARGUMENT (without the line number) for what
// is not read.

// TOOL CALL with a number or a name, Z, S, F, and oversizes of zero.
absl::StatusOr<BlockModes> ReadToolCall(const std::vector<std::string>& words);
// TOOL DEF: it makes a tool ready, and on old controls states its length.
absl::StatusOr<std::optional<BlockModes>> ReadToolDef(const std::vector<std::string>& words);
// CYCL DEF 32 (tolerance), 9 (dwell), 247 (preset), and 7, 8, 10, 11 and 19 where they change nothing. Lines
// without an effect of their own give no block.
absl::StatusOr<std::optional<BlockModes>> ReadCycleDef(const std::vector<std::string>& words);
// PLANE, TRANS and FUNCTION where they turn and shift nothing.
absl::StatusOr<BlockModes> ReadFrame(const std::vector<std::string>& words);

}  // namespace patchmill
