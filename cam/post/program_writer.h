// Writes a toolpath as the text of a program in one dialect [machining M3, M8, M14, M17, M18].
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/tool/tool.h"
#include "cam/toolpath/toolpath.h"

namespace patchmill {

struct PostParams {
  std::string dialect = "linuxcnc";
  std::string work_offset = "G54";         // G54..G59
  Vec3 program_zero = Vec3::Zero();        // point of the placed model that becomes X0 Y0 Z0
  std::string zero_name = "model origin";  // for the header
  double controller_tolerance = 0.0;       // mm, > 0, P of G64
  double clearance_z = 0.0;                // mm, tip height of rapids, placed frame
  std::vector<std::string>
      header;  // comment lines: assumptions, warnings, hash; WriteProgram makes them safe for the dialect
};

// Writes straight moves only. Coordinates have four decimals, no exponent and no "-0.0000"; moves that vanish
// in rounding are dropped. The program starts and ends with G53 G0 Z0. It switches off spindle and coolant at
// the end. Modal words are not repeated. The text is ASCII and ends with a newline. INVALID_ARGUMENT for an
// unknown dialect (the message lists the known ones) or work offset, for tool data, moves or parameters out
// of range, and for a toolpath without moves.
absl::StatusOr<std::string> WriteProgram(const Toolpath& toolpath, const Tool& tool,
                                         const PostParams& params);

std::vector<std::string> KnownDialects();
bool IsWorkOffset(std::string_view word);  // G54..G59

}  // namespace patchmill
