// Outline curves of a request -> the surface between them.
#pragma once

#include <absl/status/statusor.h>

#include "core/patch/patch.h"
#include "patchmill/v1/model_service.pb.h"

namespace patchmill {

// The surface in mm. `unit` is the length unit of the request in mm. INVALID_ARGUMENT names the field.
// RESOURCE_EXHAUSTED for a limit; limits are checked before anything is copied.
absl::StatusOr<PatchShape> OutlineSurface(const v1::BuildModelRequest& request, double unit);

}  // namespace patchmill
