#include "server/unknown_fields.h"

#include <vector>

#include <fmt/format.h>
#include <google/protobuf/descriptor.h>
#include <google/protobuf/unknown_field_set.h>

namespace patchmill {
namespace {

std::string Find(const google::protobuf::Message& message, const std::string& at) {
  const google::protobuf::Reflection& reflection = *message.GetReflection();
  const auto& unknown = reflection.GetUnknownFields(message);
  if (!unknown.empty()) return fmt::format("{}#{}", at, unknown.field(0).number());
  std::vector<const google::protobuf::FieldDescriptor*> fields;
  reflection.ListFields(message, &fields);
  for (const auto* field : fields) {
    if (field->cpp_type() != google::protobuf::FieldDescriptor::CPPTYPE_MESSAGE) continue;
    if (!field->is_repeated()) {
      std::string found =
          Find(reflection.GetMessage(message, field), fmt::format("{}{}.", at, field->name()));
      if (!found.empty()) return found;
      continue;
    }
    for (int i = 0; i < reflection.FieldSize(message, field); ++i) {
      // The path is built only for a field that is found, because models may have 100,000 patches.
      if (Find(reflection.GetRepeatedMessage(message, field, i), "").empty()) continue;
      return Find(reflection.GetRepeatedMessage(message, field, i),
                  fmt::format("{}{}[{}].", at, field->name(), i));
    }
  }
  return "";
}

}  // namespace

std::string UnknownField(const google::protobuf::Message& message) { return Find(message, ""); }

}  // namespace patchmill
