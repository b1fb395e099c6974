// What Verify is asked, checked before anything is paid for.
#pragma once

#include "cam/verify/verify.h"

namespace patchmill {

// INVALID_ARGUMENT for a tool, a parameter or a motion that cannot be judged.
absl::Status ValidateVerifyInput(const Surface& surface, const Tool& tool, const ProgramMotion& motion,
                                 const VerifyParams& params);

}  // namespace patchmill
