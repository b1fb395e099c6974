// What a serialized message holds, counted on its bytes before any of it is parsed: two bytes of an empty
// nested message become a hundred in memory, so the size on the wire says little about the cost.
#pragma once

#include <cstddef>
#include <functional>

#include <absl/status/statusor.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/io/zero_copy_stream.h>

namespace patchmill {

struct WireLimits {
  // Most elements of a repeated field of messages, strings or bytes, in the whole message together.
  std::function<std::size_t(const google::protobuf::FieldDescriptor&)> elements;
  std::size_t numbers = 0;       // most elements of all repeated fields of numbers together, packed or not
  std::size_t memory_bytes = 0;  // the most that the parsed message may take
};

struct WireCount {
  std::size_t messages = 0;  // nested ones, at any depth
  std::size_t numbers = 0;
  std::size_t memory_bytes =
      0;  // about what the parsed message takes: fields, elements, texts, unknown fields
};

// Nesting beyond this is refused, as by the parser of Protobuf.
inline constexpr int kMaxWireDepth = 100;

// Counts the next `size` bytes of `wire` as a serialized message of `type`; allocates nothing that grows with
// them, and stops at the first limit. RESOURCE_EXHAUSTED LIMIT_EXCEEDED with the path of the field that is
// too long, or "repeated_number_count" or "message_memory_bytes"; INVALID_ARGUMENT REQUEST_UNREADABLE for
// bytes that are no such message. A message that passes may still fail to parse (invalid UTF-8). Cost: one
// pass over the bytes.
absl::StatusOr<WireCount> CountWire(google::protobuf::io::ZeroCopyInputStream& wire, std::size_t size,
                                    const google::protobuf::Descriptor& type, const WireLimits& limits);

}  // namespace patchmill
