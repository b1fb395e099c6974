// From the bytes of a request to its message.
#pragma once

#include <absl/status/statusor.h>
#include <google/protobuf/message.h>

#include "server/in_flight.h"
#include "server/raw_service.h"

namespace patchmill {

// Counts the request, holds what it takes in memory, parses it into `message` and drops its bytes. Errors of
// CountWire and InFlight::Take, and REQUEST_UNREADABLE.
absl::StatusOr<InFlight::Hold> ParseRequest(RawCall& call, InFlight& in_flight,
                                            google::protobuf::Message& message);

}  // namespace patchmill
