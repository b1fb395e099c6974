#include "server/wire_count.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>
#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/message.h>
#include <google/protobuf/unknown_field_set.h>
#include <google/protobuf/wire_format_lite.h>

#include "core/base/status.h"
#include "server/errors.h"

namespace patchmill {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::internal::WireFormatLite;
using google::protobuf::io::CodedInputStream;

constexpr std::size_t kAllocationBytes = 16;  // overhead of the allocator
constexpr std::size_t kElementBytes = sizeof(void*) + kAllocationBytes;
constexpr std::size_t kTextBytes = sizeof(std::string) + kAllocationBytes;
constexpr std::size_t kUnknownFieldBytes =
    2 * sizeof(google::protobuf::UnknownField);  // twice, because the vector of them grows by doubling

// Memory of an empty message of this type.
std::size_t EmptyBytes(const Descriptor& type) {
  const google::protobuf::Message* prototype =
      google::protobuf::MessageFactory::generated_factory()->GetPrototype(&type);
  if (prototype != nullptr) return prototype->SpaceUsedLong();
  return 24 + 8 * static_cast<std::size_t>(type.field_count());
}

std::size_t NumberBytes(const FieldDescriptor& field) {
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_BOOL:
      return 1;
    case FieldDescriptor::CPPTYPE_INT32:
    case FieldDescriptor::CPPTYPE_UINT32:
    case FieldDescriptor::CPPTYPE_ENUM:
    case FieldDescriptor::CPPTYPE_FLOAT:
      return 4;
    default:
      return 8;
  }
}

bool IsMessage(const FieldDescriptor& field) { return field.cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE; }

WireFormatLite::WireType WireTypeOf(const FieldDescriptor& field) {
  return WireFormatLite::WireTypeForFieldType(static_cast<WireFormatLite::FieldType>(field.type()));
}

class Counter {
 public:
  Counter(google::protobuf::io::ZeroCopyInputStream& wire, const WireLimits& limits)
      : in_(&wire), limits_(limits) {
    in_.SetTotalBytesLimit(std::numeric_limits<int>::max());
  }

  absl::StatusOr<WireCount> Count(int size, const Descriptor& type) {
    in_.PushLimit(size);
    PM_RETURN_IF_ERROR(AddMemory(EmptyBytes(type)));
    PM_RETURN_IF_ERROR(Message(&type, 0));
    return count_;
  }

 private:
  struct Elements {
    std::size_t count = 0, most = 0;
  };

  // Counts the fields up to the current limit, or up to the end of group `group` if that is not 0. Without a
  // type all fields are unknown.
  absl::Status Message(const Descriptor* type, int group) {
    if (++depth_ > kMaxWireDepth) {
      return Unreadable(fmt::format("its messages are nested more than {} deep", kMaxWireDepth));
    }
    for (;;) {
      const std::uint32_t tag = in_.ReadTag();
      if (tag == 0) {
        if (group != 0 || !in_.ConsumedEntireMessage() || in_.BytesUntilLimit() != 0) return Unreadable();
        break;
      }
      const int number = WireFormatLite::GetTagFieldNumber(tag);
      const WireFormatLite::WireType wire = WireFormatLite::GetTagWireType(tag);
      if (number == 0) return Unreadable();
      if (wire == WireFormatLite::WIRETYPE_END_GROUP) {
        if (number != group) return Unreadable();
        break;
      }
      const FieldDescriptor* field = type == nullptr ? nullptr : type->FindFieldByNumber(number);
      PM_RETURN_IF_ERROR(Field(field, number, wire));
    }
    --depth_;
    return absl::OkStatus();
  }

  absl::Status Field(const FieldDescriptor* field, int number, WireFormatLite::WireType wire) {
    const bool length_delimited = wire == WireFormatLite::WIRETYPE_LENGTH_DELIMITED;
    const bool packed = field != nullptr && length_delimited && field->is_packable();
    // As in the parser, a wire type that differs from that of the field makes an unknown field.
    if (field == nullptr || (wire != WireTypeOf(*field) && !packed)) return Unknown(number, wire);
    path_.push_back(field);
    PM_RETURN_IF_ERROR(IsMessage(*field)  ? Nested(*field, number, wire)
                       : packed           ? Packed(*field)
                       : length_delimited ? Text(*field)
                                          : Number(*field, wire));
    path_.pop_back();
    return absl::OkStatus();
  }

  absl::Status Nested(const FieldDescriptor& field, int number, WireFormatLite::WireType wire) {
    ++count_.messages;
    PM_RETURN_IF_ERROR(AddElement(field));
    PM_RETURN_IF_ERROR(AddMemory(Empty(*field.message_type()) + kElementBytes));
    if (wire == WireFormatLite::WIRETYPE_START_GROUP) return Message(field.message_type(), number);
    PM_ASSIGN_OR_RETURN(const int size, Length());
    const CodedInputStream::Limit outer = in_.PushLimit(size);
    PM_RETURN_IF_ERROR(Message(field.message_type(), 0));
    in_.PopLimit(outer);
    return absl::OkStatus();
  }

  absl::Status Packed(const FieldDescriptor& field) {
    PM_ASSIGN_OR_RETURN(const int size, Length());
    PM_RETURN_IF_ERROR(AddMemory(kElementBytes));
    const WireFormatLite::WireType wire = WireTypeOf(field);
    if (wire == WireFormatLite::WIRETYPE_VARINT) return PackedVarints(field, size);
    const int each = wire == WireFormatLite::WIRETYPE_FIXED64 ? 8 : 4;
    if (size % each != 0) return Unreadable();
    PM_RETURN_IF_ERROR(AddNumbers(field, static_cast<std::size_t>(size / each)));
    return Skip(size);
  }

  // A number ends with each byte below 128.
  absl::Status PackedVarints(const FieldDescriptor& field, int size) {
    bool ended = true;
    while (size > 0) {
      const void* data = nullptr;
      int available = 0;
      if (!in_.GetDirectBufferPointer(&data, &available)) return Unreadable();
      const int here = std::min(available, size);
      const auto* bytes = static_cast<const std::uint8_t*>(data);
      const auto numbers = std::count_if(bytes, bytes + here, [](std::uint8_t b) { return b < 0x80; });
      PM_RETURN_IF_ERROR(AddNumbers(field, static_cast<std::size_t>(numbers)));
      ended = bytes[here - 1] < 0x80;
      PM_RETURN_IF_ERROR(Skip(here));
      size -= here;
    }
    return ended ? absl::OkStatus() : Unreadable();
  }

  absl::Status Number(const FieldDescriptor& field, WireFormatLite::WireType wire) {
    if (field.is_repeated()) PM_RETURN_IF_ERROR(AddNumbers(field, 1));
    return SkipNumber(wire);
  }

  absl::Status Text(const FieldDescriptor& field) {
    PM_ASSIGN_OR_RETURN(const int size, Length());
    PM_RETURN_IF_ERROR(AddElement(field));
    PM_RETURN_IF_ERROR(
        AddMemory((field.is_repeated() ? kElementBytes : 0) + kTextBytes + static_cast<std::size_t>(size)));
    return Skip(size);
  }

  absl::Status Unknown(int number, WireFormatLite::WireType wire) {
    PM_RETURN_IF_ERROR(AddMemory(kUnknownFieldBytes));
    if (wire == WireFormatLite::WIRETYPE_START_GROUP) {
      PM_RETURN_IF_ERROR(AddMemory(sizeof(google::protobuf::UnknownFieldSet) + kAllocationBytes));
      return Message(nullptr, number);
    }
    if (wire != WireFormatLite::WIRETYPE_LENGTH_DELIMITED) return SkipNumber(wire);
    PM_ASSIGN_OR_RETURN(const int size, Length());
    PM_RETURN_IF_ERROR(AddMemory(kTextBytes + static_cast<std::size_t>(size)));
    return Skip(size);
  }

  absl::Status SkipNumber(WireFormatLite::WireType wire) {
    std::uint64_t ignored = 0;
    switch (wire) {
      case WireFormatLite::WIRETYPE_VARINT:
        return in_.ReadVarint64(&ignored) ? absl::OkStatus() : Unreadable();
      case WireFormatLite::WIRETYPE_FIXED64:
        return Skip(8);
      case WireFormatLite::WIRETYPE_FIXED32:
        return Skip(4);
      default:
        return Unreadable();
    }
  }

  absl::Status Skip(int bytes) { return in_.Skip(bytes) ? absl::OkStatus() : Unreadable(); }

  // Skips bytes; never beyond the end.
  absl::StatusOr<int> Length() {
    std::uint32_t size = 0;
    if (!in_.ReadVarint32(&size) || size > static_cast<std::uint32_t>(in_.BytesUntilLimit()))
      return Unreadable();
    return static_cast<int>(size);
  }

  absl::Status AddElement(const FieldDescriptor& field) {
    if (!field.is_repeated()) return absl::OkStatus();
    const auto [at, fresh] = elements_.try_emplace(&field);
    Elements& elements = at->second;
    if (fresh) elements.most = limits_.elements(field);
    if (++elements.count <= elements.most) return absl::OkStatus();
    return LimitError(Path(), static_cast<double>(elements.most), static_cast<double>(elements.count),
                      "counting stopped there");
  }

  absl::Status AddNumbers(const FieldDescriptor& field, std::size_t numbers) {
    count_.numbers += numbers;
    if (count_.numbers > limits_.numbers) {
      return LimitError("repeated_number_count", static_cast<double>(limits_.numbers),
                        static_cast<double>(count_.numbers), "counting stopped at " + Path());
    }
    return AddMemory(numbers * NumberBytes(field));
  }

  absl::Status AddMemory(std::size_t bytes) {
    count_.memory_bytes += bytes;
    if (count_.memory_bytes <= limits_.memory_bytes) return absl::OkStatus();
    return LimitError("message_memory_bytes", static_cast<double>(limits_.memory_bytes),
                      static_cast<double>(count_.memory_bytes), "counting stopped at " + Path());
  }

  std::size_t Empty(const Descriptor& type) {
    const auto [known, fresh] = empty_.try_emplace(&type, 0);
    if (fresh) known->second = EmptyBytes(type);
    return known->second;
  }

  std::string Path() const {
    std::string path;
    for (const FieldDescriptor* field : path_) path += (path.empty() ? "" : ".") + field->name();
    return path.empty() ? "the message" : path;
  }

  absl::Status Unreadable(std::string_view why = "its bytes are malformed or cut off") const {
    return RequestUnreadableError(fmt::format("the request cannot be read at {}: {}", Path(), why));
  }

  CodedInputStream in_;
  const WireLimits& limits_;
  WireCount count_;
  int depth_ = 0;
  std::vector<const FieldDescriptor*> path_;
  std::unordered_map<const FieldDescriptor*, Elements> elements_;
  std::unordered_map<const Descriptor*, std::size_t> empty_;
};

}  // namespace

absl::StatusOr<WireCount> CountWire(google::protobuf::io::ZeroCopyInputStream& wire, std::size_t size,
                                    const Descriptor& type, const WireLimits& limits) {
  constexpr int kMost = std::numeric_limits<int>::max();
  if (size >= static_cast<std::size_t>(kMost)) {
    return LimitError("message_bytes", kMost, static_cast<double>(size));
  }
  return Counter(wire, limits).Count(static_cast<int>(size), type);
}

}  // namespace patchmill
