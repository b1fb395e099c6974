// Checks the arguments of Verify before any cost is paid.
#pragma once

#include "cam/verify/verify.h"

namespace patchmill {

// INVALID_ARGUMENT if the tool, a parameter or the motion cannot be judged.
absl::Status ValidateVerifyInput(const Surface& surface, const Tool& tool, const ProgramMotion& motion,
                                 const VerifyParams& params);

}  // namespace patchmill
