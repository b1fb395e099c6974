// Toolpath -> program text of one dialect ([machining M3, M8, M14, M17, M18]). Dialects are data.
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
  double controller_tolerance = 0.0;       // mm, P of G64; > 0
  double clearance_z = 0.0;                // mm, tip, placed frame
  std::vector<std::string>
      header;  // comment lines: assumptions, warnings, hash; made safe for the dialect here
};

// Straight moves only. Four decimals, no exponent, no "-0.0000"; moves that vanish in rounding are dropped.
// Starts and ends with G53 G0 Z0; spindle and coolant off at the end; modal words suppressed; ASCII; ends in
// a newline. INVALID_ARGUMENT for an unknown dialect (lists the known ones) or work offset.
absl::StatusOr<std::string> WriteProgram(const Toolpath& toolpath, const Tool& tool,
                                         const PostParams& params);

std::vector<std::string> KnownDialects();
bool IsWorkOffset(std::string_view word);  // G54..G59

}  // namespace patchmill
