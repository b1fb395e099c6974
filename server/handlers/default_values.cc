#include "server/handlers/default_values.h"

#include <fmt/format.h>

#include "core/base/status.h"
#include "server/convert/job.h"

namespace patchmill {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using Values = std::map<std::string, std::string>;

void AddFields(const Message& message, const std::string& at, Values& values);

void AddValue(const Message& message, const FieldDescriptor& field, const std::string& path, Values& values) {
  const google::protobuf::Reflection& of = *message.GetReflection();
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_MESSAGE:
      return AddFields(of.GetMessage(message, &field), path, values);
    case FieldDescriptor::CPPTYPE_DOUBLE:
      values[path] = fmt::format("{:.10g}", of.GetDouble(message, &field));
      return;
    case FieldDescriptor::CPPTYPE_INT32:
      values[path] = fmt::format("{}", of.GetInt32(message, &field));
      return;
    case FieldDescriptor::CPPTYPE_BOOL:
      values[path] = of.GetBool(message, &field) ? "true" : "false";
      return;
    case FieldDescriptor::CPPTYPE_ENUM:
      values[path] = of.GetEnum(message, &field)->name();
      return;
    case FieldDescriptor::CPPTYPE_STRING:
      if (field.type() == FieldDescriptor::TYPE_STRING) values[path] = of.GetString(message, &field);
      return;
    default:
      return;
  }
}

// The fields that are set, with those of the messages in them. Of lists, only those of messages.
void AddFields(const Message& message, const std::string& at, Values& values) {
  std::vector<const FieldDescriptor*> fields;
  const google::protobuf::Reflection& of = *message.GetReflection();
  of.ListFields(message, &fields);
  for (const FieldDescriptor* field : fields) {
    const std::string path = at + "." + field->name();
    if (!field->is_repeated()) {
      AddValue(message, *field, path, values);
    } else if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
      for (int k = 0; k < of.FieldSize(message, field); ++k)
        AddFields(of.GetRepeatedMessage(message, field, k), fmt::format("{}[{}]", path, k), values);
    }
  }
}

// A job that states what it has to. Its numbers depend on `factor`.
v1::Job LeastJob(double factor) {
  v1::Job job;
  v1::Operation& operation = *job.add_operations();
  operation.set_scallop_mm(0.01 * factor);
  operation.set_tolerance_mm(0.01 * factor);
  v1::Tool& tool = *operation.mutable_tool();
  tool.set_number(static_cast<int>(factor));
  tool.mutable_ball_end()->set_diameter_mm(6.0 * factor);
  tool.set_spindle_rpm(6000.0 * factor);
  tool.set_feed_mm_per_min(600.0 * factor);
  tool.set_plunge_feed_mm_per_min(200.0 * factor);
  return job;
}

// What the job has become that it did not state.
Values Added(const v1::Job& stated) {
  FieldErrors errors;
  const Job job = FromProto(stated, v1::Post(), "job", errors);
  PM_CHECK(errors.empty());
  Values before, values;
  AddFields(stated, "job", before);
  AddFields(ToProto(job, "", ""), "job", values);
  AddFields(PostToProto(job), "post", values);
  for (const auto& [path, value] : before) values.erase(path);
  return values;
}

Values MakeDefaults() {
  Values values = Added(LeastJob(1.0));
  const Values others = Added(LeastJob(2.0));
  std::erase_if(values, [&others](const auto& one) {
    const auto other = others.find(one.first);
    return other == others.end() || other->second != one.second;
  });
  return values;
}

}  // namespace

const std::map<std::string, std::string>& JobDefaults() {
  static const auto* const values = new Values(MakeDefaults());
  return *values;
}

}  // namespace patchmill
