// Outline curves on the wire -> the surface between them.
#pragma once

#include <absl/status/statusor.h>

#include "core/patch/patch.h"
#include "patchmill/v1/model_service.pb.h"

namespace patchmill {

// In mm; `unit`: mm of one length unit of the request. INVALID_ARGUMENT with the field; RESOURCE_EXHAUSTED
// for a limit, checked before anything is copied.
absl::StatusOr<PatchShape> OutlineSurface(const v1::BuildModelRequest& request, double unit);

}  // namespace patchmill
