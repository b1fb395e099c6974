#include "server/reflection_service.h"

#include <set>
#include <string_view>
#include <utility>

#include <google/protobuf/descriptor.h>
#include <google/protobuf/descriptor.pb.h>
#include <google/protobuf/unknown_field_set.h>
#include <grpcpp/support/status_code_enum.h>

#include "server/errors.h"

namespace patchmill {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::DescriptorPool;
using google::protobuf::FieldDescriptor;
using google::protobuf::FileDescriptor;
// reflection.proto is not packaged as a library: its small messages are read and written by field number.
using Fields = google::protobuf::UnknownFieldSet;

// Of ServerReflectionRequest.
enum RequestField { kByFilename = 3, kBySymbol = 4, kByExtension = 5, kExtensionsOfType = 6, kList = 7 };
// Of ServerReflectionResponse.
enum ResponseField { kHost = 1, kOriginal = 2, kFiles = 4, kExtensions = 5, kServices = 6, kError = 7 };

std::string Bytes(const Fields& fields) {
  std::string bytes;
  fields.SerializeToString(&bytes);
  return bytes;
}

struct Reflected {
  int field = kError;
  std::string message;
};

Reflected ErrorOf(grpc::StatusCode code, const std::string& why) {
  Fields error;
  error.AddVarint(1, static_cast<std::uint64_t>(code));
  error.AddLengthDelimited(2, why);
  return {kError, Bytes(error)};
}

Reflected NotKnown(std::string_view what) {
  return ErrorOf(grpc::StatusCode::NOT_FOUND, std::string(what) + " is not known");
}

// With all that they import, each once.
void AddFiles(const FileDescriptor& file, std::set<const FileDescriptor*>& added, Fields& fields) {
  if (!added.insert(&file).second) return;
  google::protobuf::FileDescriptorProto proto;
  file.CopyTo(&proto);
  fields.AddLengthDelimited(1, proto.SerializeAsString());
  for (int k = 0; k < file.dependency_count(); ++k) AddFiles(*file.dependency(k), added, fields);
}

Reflected FilesOf(const FileDescriptor* file, std::string_view what) {
  if (file == nullptr) return NotKnown(what);
  Fields files;
  std::set<const FileDescriptor*> added;
  AddFiles(*file, added, files);
  return {kFiles, Bytes(files)};
}

// An ExtensionRequest: 1 the type that is extended, 2 the number.
Reflected FileOfExtension(const std::string& request) {
  Fields fields;
  if (!fields.ParseFromString(request)) {
    return ErrorOf(grpc::StatusCode::INVALID_ARGUMENT, "the request is no ExtensionRequest");
  }
  std::string type;
  int number = 0;
  for (int k = 0; k < fields.field_count(); ++k) {
    const auto& field = fields.field(k);
    if (field.number() == 1 && field.type() == field.TYPE_LENGTH_DELIMITED) type = field.length_delimited();
    if (field.number() == 2 && field.type() == field.TYPE_VARINT) number = static_cast<int>(field.varint());
  }
  const DescriptorPool& pool = *DescriptorPool::generated_pool();
  const Descriptor* extended = pool.FindMessageTypeByName(type);
  const FieldDescriptor* extension =
      extended == nullptr ? nullptr : pool.FindExtensionByNumber(extended, number);
  return FilesOf(extension == nullptr ? nullptr : extension->file(), "the extension");
}

Reflected ExtensionsOf(const std::string& type) {
  const DescriptorPool& pool = *DescriptorPool::generated_pool();
  const Descriptor* extended = pool.FindMessageTypeByName(type);
  if (extended == nullptr) return NotKnown("the type");
  std::vector<const FieldDescriptor*> extensions;
  pool.FindAllExtensions(extended, &extensions);
  Fields numbers;
  numbers.AddLengthDelimited(1, type);
  for (const FieldDescriptor* extension : extensions) {
    numbers.AddVarint(2, static_cast<std::uint64_t>(extension->number()));
  }
  return {kExtensions, Bytes(numbers)};
}

Reflected ListOf(const std::vector<std::string>& services) {
  Fields list;
  for (const std::string& service : services) {
    Fields name;
    name.AddLengthDelimited(1, service);
    list.AddLengthDelimited(1, Bytes(name));
  }
  return {kServices, Bytes(list)};
}

Reflected Respond(int field, const std::string& text, const std::vector<std::string>& services) {
  const DescriptorPool& pool = *DescriptorPool::generated_pool();
  switch (field) {
    case kByFilename:
      return FilesOf(pool.FindFileByName(text), "the file");
    case kBySymbol:
      return FilesOf(pool.FindFileContainingSymbol(text), "the symbol");
    case kByExtension:
      return FileOfExtension(text);
    case kExtensionsOfType:
      return ExtensionsOf(text);
    case kList:
      return ListOf(services);
    default:
      return ErrorOf(grpc::StatusCode::INVALID_ARGUMENT, "the request asks for nothing");
  }
}

absl::StatusOr<std::string> Reflect(const std::string& request, const std::vector<std::string>& services) {
  Fields fields;
  if (!fields.ParseFromString(request)) {
    return RequestUnreadableError("the request is no ServerReflectionRequest");
  }
  std::string host, text;
  int asked = 0;  // the last of a oneof counts
  for (int k = 0; k < fields.field_count(); ++k) {
    const auto& field = fields.field(k);
    if (field.type() != field.TYPE_LENGTH_DELIMITED) continue;
    if (field.number() == 1) {
      host = field.length_delimited();
    } else if (field.number() >= kByFilename && field.number() <= kList) {
      asked = field.number();
      text = field.length_delimited();
    }
  }
  const Reflected response = Respond(asked, text, services);
  Fields answer;
  answer.AddLengthDelimited(kHost, host);
  answer.AddLengthDelimited(kOriginal, request);
  answer.AddLengthDelimited(response.field, response.message);
  return Bytes(answer);
}

}  // namespace

std::unique_ptr<SmallService> MakeReflectionService(std::vector<std::string> services, InFlight& in_flight,
                                                    CallRules rules) {
  std::vector<SmallMethod> methods;
  methods.push_back(
      {"/grpc.reflection.v1alpha.ServerReflection/ServerReflectionInfo", SmallMethod::Then::kRead,
       [services = std::move(services)](const std::string& request) { return Reflect(request, services); }});
  return MakeSmallService(std::move(methods), in_flight, std::move(rules));
}

}  // namespace patchmill
