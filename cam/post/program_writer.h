// Writes a toolpath as the text of a program in one dialect [machining M3, M8, M14, M17, M18].
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/post/dialect.h"
#include "cam/tool/tool.h"
#include "cam/toolpath/toolpath.h"

namespace patchmill {

// Moves that belong together, for the operator.
struct ProgramSection {
  // The lowest and the highest tip of its passes, mm, program frame.
  struct Heights {
    double low = 0.0, high = 0.0;
  };

  std::size_t first_move = 0;  // index into Toolpath::moves
  std::string comment;         // without lengths: they would be in another unit than the program
  std::optional<Heights> tip = std::nullopt;  // added to the comment, in the unit of the program
  int first_pass = 0;                         // Move::pass with which the section begins, or goes on
  bool continued = false;                     // the section goes on after a restart point
  // The control may be started here. The tool is clear of everything before the first move, which is a rapid.
  bool restart = false;
};

struct PostParams {
  Dialect dialect = LinuxCnc();
  ProgramUnit unit = ProgramUnit::kMillimeter;  // of the text; all else is in mm
  int program_number = 1;                       // 1..9999, where the dialect numbers its programs
  std::string work_offset = "G54";              // G54..G59
  Vec3 program_zero = Vec3::Zero();             // point of the placed model that becomes X0 Y0 Z0
  std::string zero_name = "model origin";       // for the header
  // mm, >= 0: by how much the control may leave the path. The dialect's word states it. If the dialect has
  // none, it is the user's own statement about the control. 0 means exact stop, if the control needs it.
  double controller_tolerance = 0.0;
  double clearance_z = 0.0;  // mm, tip height of rapids, placed frame
  // mm, > 0: largest distance of the chords from an arc that is not written as one.
  double chord_sagitta = 0.001;
  std::vector<std::string>
      header;  // comment lines: assumptions, warnings, hash; WriteProgram makes them safe for the dialect
  std::vector<ProgramSection> sections = {};  // by first_move, ascending; a comment before each
  // Before sections with `restart` stand the lines of the dialect that begin a program anew.
  bool restart_points = false;
};

// Writes straight moves, and arcs where the dialect has them. An arc is written as two, or else as chords,
// if no rounded centre keeps the rules for the radii at its ends (round_arc.h); as chords also if its
// plane, its radius or its climb is not the dialect's. Coordinates have the dialect's decimals, no exponent
// and no "-0.0000"; moves that vanish in rounding are dropped. Before and after the moves stand the lines
// of the dialect. Modal words are not repeated. The text is ASCII and ends with a newline. INVALID_ARGUMENT
// for an unknown work offset, for a unit that the dialect does not have, for tool data, moves or parameters
// out of range, for restart points where the dialect has no lines for them, and for a toolpath without
// moves.
absl::StatusOr<std::string> WriteProgram(const Toolpath& toolpath, const Tool& tool,
                                         const PostParams& params);

struct WrittenProgram {
  std::string text;
  // By the index of the toolpath's move: the line, from 1, that makes it, or its first one if there are more.
  // A move that vanished in rounding has the line before; the first move has 0, if the lines before the
  // motion make it.
  std::vector<int> move_lines;
  // Of each restart point: the line at which the control may start, and the line behind the moves that
  // follow it up to the next restart point or the end.
  struct Restart {
    int first_line = 0, end_line = 0;
  };
  std::vector<Restart> restarts;
};
absl::StatusOr<WrittenProgram> WriteProgramWithLines(const Toolpath& toolpath, const Tool& tool,
                                                     const PostParams& params);

// The line that switches the coolant on; empty if it stays off, or if the dialect has no word for it.
std::string CoolantLine(const Dialect& dialect, Coolant coolant);
bool IsWorkOffset(std::string_view word);  // G54..G59

}  // namespace patchmill
