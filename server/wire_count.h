// Counts what a serialized message holds, on its bytes and before any of it is parsed. The size on the wire
// says little about the cost: an empty nested message has two bytes there and a hundred in memory.
#pragma once

#include <cstddef>
#include <functional>

#include <absl/status/statusor.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/io/zero_copy_stream.h>

namespace patchmill {

struct WireLimits {
  // Largest number of elements of a repeated field of messages, strings or bytes, in the whole message
  // together.
  std::function<std::size_t(const google::protobuf::FieldDescriptor&)> elements;
  std::size_t numbers = 0;       // largest number of elements of all repeated numbers together, packed or not
  std::size_t memory_bytes = 0;  // largest memory of the parsed message
};

struct WireCount {
  std::size_t messages = 0;  // nested messages, at any depth
  std::size_t numbers = 0;
  std::size_t memory_bytes =
      0;  // about the memory of the parsed message: fields, elements, texts, unknown fields
};

// Deeper nesting is refused, as the parser of Protobuf does.
inline constexpr int kMaxWireDepth = 100;

// Counts the next `size` bytes of `wire` as a serialized message of `type`. It allocates nothing that grows
// with the size, and stops at the first limit. RESOURCE_EXHAUSTED LIMIT_EXCEEDED names the path of the list
// that is too long, or "repeated_number_count" or "message_memory_bytes". INVALID_ARGUMENT
// REQUEST_UNREADABLE if the bytes form no such message. A message that passes may still fail to parse
// (invalid UTF-8). Cost: one pass over the bytes.
absl::StatusOr<WireCount> CountWire(google::protobuf::io::ZeroCopyInputStream& wire, std::size_t size,
                                    const google::protobuf::Descriptor& type, const WireLimits& limits);

}  // namespace patchmill
