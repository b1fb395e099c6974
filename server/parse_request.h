// Turns the bytes of a request into its message.
#pragma once

#include <absl/status/statusor.h>
#include <google/protobuf/message.h>

#include "server/in_flight.h"
#include "server/raw_service.h"

namespace patchmill {

// Counts the request, holds the memory that it takes, parses it into `message` and frees its bytes. Errors:
// those of CountWire and InFlight::Take, and REQUEST_UNREADABLE.
absl::StatusOr<InFlight::Hold> ParseRequest(RawCall& call, InFlight& in_flight,
                                            google::protobuf::Message& message);

}  // namespace patchmill
