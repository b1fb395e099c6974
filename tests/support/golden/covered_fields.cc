#include "tests/support/golden/covered_fields.h"

#include <algorithm>

#include "patchmill/v1/toolpath_service.pb.h"

namespace patchmill::testing {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::EnumDescriptor;
using google::protobuf::EnumValueDescriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

const std::set<std::string> kNotAsked = {
    // Models have tests of their own.
    "Job.source",
    "Stock.model",
    // How to answer, not what.
    "GenerateProgramRequest.outputs",
    "GenerateProgramRequest.validate_only",
    "GenerateProgramRequest.request_id",
    "GenerateProgramRequest.max_threads",
    "GenerateProgramRequest.tessellation_chord_mm",
    // UNIMPLEMENTED.
    "Post.spindle_dwell_s",
    // An error.
    "LengthUnit.LENGTH_UNIT_METER",
};

std::string Name(const FieldDescriptor& field) {
  return field.containing_type()->name() + "." + field.name();
}
std::string Name(const EnumValueDescriptor& value) { return value.type()->name() + "." + value.name(); }

// All that a message of this type can say.
void AddAll(const Descriptor& type, std::set<std::string>& all) {
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    if (kNotAsked.contains(Name(field)) || !all.insert(Name(field)).second) continue;
    if (field.message_type() != nullptr) AddAll(*field.message_type(), all);
    const EnumDescriptor* values = field.enum_type();
    for (int k = 1; values != nullptr && k < values->value_count(); ++k) {  // 0: not said
      if (!kNotAsked.contains(Name(*values->value(k)))) all.insert(Name(*values->value(k)));
    }
  }
}

}  // namespace

void CoveredFields::Add(const Message& message) {
  const auto* reflection = message.GetReflection();
  std::vector<const FieldDescriptor*> fields;
  reflection->ListFields(message, &fields);
  for (const FieldDescriptor* field : fields) {
    seen_.insert(Name(*field));
    const int count = field->is_repeated() ? reflection->FieldSize(message, field) : 1;
    for (int i = 0; i < count; ++i) {
      if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
        Add(field->is_repeated() ? reflection->GetRepeatedMessage(message, field, i)
                                 : reflection->GetMessage(message, field));
      } else if (field->cpp_type() == FieldDescriptor::CPPTYPE_ENUM) {
        seen_.insert(Name(*(field->is_repeated() ? reflection->GetRepeatedEnum(message, field, i)
                                                 : reflection->GetEnum(message, field))));
      }
    }
  }
}

std::vector<std::string> CoveredFields::Missing() const {
  std::set<std::string> all;
  AddAll(*v1::GenerateProgramRequest::descriptor(), all);
  std::vector<std::string> missing;
  std::set_difference(all.begin(), all.end(), seen_.begin(), seen_.end(), std::back_inserter(missing));
  return missing;
}

}  // namespace patchmill::testing
