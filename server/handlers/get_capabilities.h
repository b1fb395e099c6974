// ServerService.GetCapabilities: what the server can do.
#pragma once

#include <absl/status/status.h>

#include "patchmill/v1/server_service.pb.h"
#include "server/call.h"

namespace patchmill {

absl::Status HandleGetCapabilities(const Call& call, const v1::GetCapabilitiesRequest& request,
                                   v1::GetCapabilitiesResponse* response);

}  // namespace patchmill
