// Limits on the size of a model, checked before anything of it is copied.
#pragma once

#include <absl/status/status.h>

#include "patchmill/v1/model.pb.h"

namespace patchmill {

// RESOURCE_EXHAUSTED with the first limit of server/limits.h that the model exceeds.
absl::Status CheckLimits(const v1::PatchModel& proto);

}  // namespace patchmill
