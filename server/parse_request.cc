#include "server/parse_request.h"

#include <fmt/format.h>
#include <grpcpp/grpcpp.h>
#include <grpcpp/impl/codegen/proto_utils.h>
#include <grpcpp/support/proto_buffer_reader.h>

#include "core/base/status.h"
#include "server/errors.h"
#include "server/wire_count.h"
#include "server/wire_limits.h"

namespace patchmill {

absl::StatusOr<InFlight::Hold> ParseRequest(RawCall& call, InFlight& in_flight,
                                            google::protobuf::Message& message) {
  const std::size_t size = call.request().Length();
  WireCount count;
  {
    grpc::ProtoBufferReader reader(&call.request());
    if (!reader.status().ok()) return RequestUnreadableError("the request's bytes cannot be read");
    PM_ASSIGN_OR_RETURN(
        count, CountWire(reader, size, *message.GetDescriptor(), ListLimits(in_flight.limit_bytes())));
  }
  PM_ASSIGN_OR_RETURN(InFlight::Hold hold, in_flight.Take(count.memory_bytes));
  if (call.Cancelled()) return absl::CancelledError("cancelled by the caller");
  if (!grpc::SerializationTraits<google::protobuf::Message>::Deserialize(&call.request(), &message).ok()) {
    return RequestUnreadableError(fmt::format("the request is no {}", message.GetDescriptor()->full_name()));
  }
  call.DropRequest();
  if (call.Cancelled()) return absl::CancelledError("cancelled by the caller");
  return hold;
}

}  // namespace patchmill
