// Reads the text of a program back into motion, for the verifier [verification, section 3]. It reads any
// RS274-like text, ours or another's.
#pragma once

#include <map>
#include <optional>
#include <string_view>

#include <absl/status/statusor.h>

#include "cam/post/dialect.h"
#include "cam/toolpath/toolpath.h"
#include "core/base/run_context.h"

namespace patchmill {

struct ReaderParams {
  double arc_chord_error = 1e-4;       // mm; largest sagitta of the chords of arcs
  std::size_t max_moves = 5'000'000;   // these take 400 MB
  std::size_t max_line_length = 1000;  // characters
  const RunContext* run = nullptr;     // polled if set
  Dialect dialect = LinuxCnc();
  // mm: by how much the control leaves the path while no exact stop is in force, if the dialect has no word
  // that says so. Unset: without a limit.
  std::optional<double> control_deviation = {};
  // While the program has no word for the path, the control is assumed to stop exactly at every point. If
  // false, such a program is judged as one with a G64 that states no limit.
  bool assume_exact_path = false;
  // mm, at most 0: a Z of G53, SUPA or M91 from here up counts as above everything. Unset: the dialect's
  // machine_top.
  std::optional<double> machine_z_safe = {};
  bool run_deletable_lines = true;  // lines that start with / (block delete) run
  bool several_tools = false;       // the program may change the tool; ProgramMove::tool says which one moves
  // Numbers of the tools that programs may call by their names, in small letters.
  std::map<std::string, int> tools_by_name = {};
};

// Reads G0-G3, G4, G17-G19, G20/G21, G28, G30, G40, G43/G49, G53, G54-G59, G61/G61.1/G64, G73, G80-G83,
// G90/G91, G90.1/G91.1, G94, G98/G99, F, S, T, M0-M9, M30, comments, N, /, the name of a program and %, the
// words of the dialect, and those of its control (word_rules.h). Lines of Siemens and of Heidenhain
// conversational programs are read into the same groups (siemens_block.h, klartext_block.h). Positions are
// those of the program (the tip, after G43), in mm. The words of a line take effect in LinuxCNC's order,
// whatever their order in the line: F counts in the unit before the line (in the new one where the dialect
// says so); then come G20/G21; coordinates and G64 P count in the new unit.
//
// G28 and G30 go straight to their coordinates first, then to the reference point, which is taken as above
// everything. An X or Y that goes to a place of the machine (G28, G53) is unknown from there on. Canned
// cycles are expanded (drilling_cycle.h). G93 and G95 are errors where something is fed under them; G41 and
// G42 are errors unless their offset is zero.
//
// INVALID_ARGUMENT with its line ("line 12: ...") for any other word. RESOURCE_EXHAUSTED for more than
// max_moves. CANCELLED and DEADLINE_EXCEEDED from `run`. Cost: one second for three million lines.
absl::StatusOr<ProgramMotion> ReadProgram(std::string_view text, const ReaderParams& params = {});

}  // namespace patchmill
