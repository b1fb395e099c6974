// What the count of a serialized message owes whatever bytes come. Used by the fuzz target and by its replay
// in tests/service.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/message.h>

#include "server/errors.h"
#include "server/limits.h"
#include "server/wire_count.h"

namespace patchmill {

inline WireLimits NoWireLimits() {
  constexpr std::size_t kAny = std::numeric_limits<std::size_t>::max() / 2;
  return {[](const google::protobuf::FieldDescriptor&) { return kAny; }, kAny, kAny};
}

inline absl::StatusOr<WireCount> CountString(const std::string& bytes,
                                             const google::protobuf::Descriptor& type,
                                             const WireLimits& limits, int block = -1) {
  google::protobuf::io::ArrayInputStream stream(bytes.data(), static_cast<int>(bytes.size()), block);
  return CountWire(stream, bytes.size(), type, limits);
}

// Nested messages and numbers of lists, by reflection on what was parsed. Unknown fields are not seen.
inline void AddParsed(const google::protobuf::Message& message, WireCount& count) {
  const google::protobuf::Reflection& reflection = *message.GetReflection();
  std::vector<const google::protobuf::FieldDescriptor*> fields;
  reflection.ListFields(message, &fields);
  for (const auto* field : fields) {
    const bool nested = field->cpp_type() == google::protobuf::FieldDescriptor::CPPTYPE_MESSAGE;
    const bool text = field->cpp_type() == google::protobuf::FieldDescriptor::CPPTYPE_STRING;
    const int size = field->is_repeated() ? reflection.FieldSize(message, field) : 1;
    if (nested) count.messages += static_cast<std::size_t>(size);
    if (!nested && !text && field->is_repeated()) count.numbers += static_cast<std::size_t>(size);
    for (int i = 0; nested && i < size; ++i) {
      AddParsed(field->is_repeated() ? reflection.GetRepeatedMessage(message, field, i)
                                     : reflection.GetMessage(message, field),
                count);
    }
  }
}

// An error is clear and fits the wire. What parses is counted: at least what is there (a field that comes
// twice is counted twice), and the memory is not understated by more than the reserve of growing lists. The
// size of the blocks the bytes come in changes nothing, and a limit below what was counted is passed.
inline bool KeepsWireCountContract(const std::string& bytes, google::protobuf::Message& message) {
  const google::protobuf::Descriptor& type = *message.GetDescriptor();
  const absl::StatusOr<WireCount> counted = CountString(bytes, type, NoWireLimits());
  const absl::StatusOr<WireCount> in_blocks = CountString(bytes, type, NoWireLimits(), 3);
  if (counted.ok() != in_blocks.ok()) return false;
  if (!counted.ok()) {
    const grpc::Status status = ToGrpcStatus(counted.status());
    return status.error_code() == grpc::StatusCode::INVALID_ARGUMENT && !status.error_message().empty() &&
           status.error_details().size() <= limits::kMaxStatusBytes && !message.ParseFromString(bytes);
  }
  if (counted->messages != in_blocks->messages || counted->numbers != in_blocks->numbers ||
      counted->memory_bytes != in_blocks->memory_bytes) {
    return false;
  }
  WireLimits less = NoWireLimits();
  less.memory_bytes = counted->memory_bytes - 1;
  if (!absl::IsResourceExhausted(CountString(bytes, type, less).status())) return false;
  if (!message.ParseFromString(bytes)) return true;
  WireCount parsed;
  AddParsed(message, parsed);
  return counted->messages >= parsed.messages && counted->numbers >= parsed.numbers &&
         4 * counted->memory_bytes >= message.SpaceUsedLong();
}

}  // namespace patchmill
