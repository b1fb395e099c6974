// Health and reflection, through the wire.
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <google/protobuf/descriptor.pb.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include "tests/service/embedded.h"
#include "tests/service/raw_stub.h"
#include "tests/service/status_matchers.h"

namespace patchmill {
namespace {

using grpc::StatusCode;
using testing::CallWithBytes;
using testing::Embedded;
using ::testing::HasSubstr;
using testing::InfoOf;
using testing::kHealthCheck;
using testing::kHealthWatch;
using testing::kReflection;
using testing::LengthDelimited;
using testing::RawStream;

const std::string kServing = "\x08\x01", kNotServing = "\x08\x02", kServiceUnknown = "\x08\x03";

TEST(SmallService, ALongRequestIsRefusedWithTheLimit) {
  const Embedded embedded;
  for (const char* method : {kHealthCheck, kHealthWatch, kReflection}) {
    const grpc::Status status =
        CallWithBytes(embedded.channel, method, LengthDelimited(1, std::string(5000, 'x')));
    EXPECT_EQ(status.error_code(), StatusCode::RESOURCE_EXHAUSTED) << method << status.error_message();
    EXPECT_EQ(InfoOf(status).limit(), "message_bytes") << method;
  }
}

TEST(SmallService, ARequestThatIsNoMessageIsRefused) {
  const Embedded embedded;
  for (const char* method : {kHealthCheck, kHealthWatch, kReflection}) {
    EXPECT_EQ(InfoOf(CallWithBytes(embedded.channel, method, "\x0A\x7F")).reason(), "REQUEST_UNREADABLE");
  }
}

TEST(HealthWatch, TellsOfTheDrain) {
  const Embedded embedded = testing::EmbeddedOnAPort();
  RawStream all(embedded.channel, kHealthWatch), unknown(embedded.channel, kHealthWatch);
  ASSERT_TRUE(all.Write(""));
  EXPECT_EQ(all.Read(), kServing);
  ASSERT_TRUE(unknown.Write(LengthDelimited(1, "no.such.Service")));
  EXPECT_EQ(unknown.Read(), kServiceUnknown);
  embedded.server->Drain(0.2);
  EXPECT_EQ(all.Read(), kNotServing);
  EXPECT_EQ(all.Read(), std::nullopt);
  EXPECT_EQ(unknown.Read(), std::nullopt);
}

// The bytes of the field of that number, each time that it is there.
std::vector<std::string> FieldsOf(const std::string& message, int number) {
  google::protobuf::UnknownFieldSet fields;
  EXPECT_TRUE(fields.ParseFromString(message));
  std::vector<std::string> found;
  for (int k = 0; k < fields.field_count(); ++k) {
    if (fields.field(k).number() == number) found.push_back(fields.field(k).length_delimited());
  }
  return found;
}

TEST(Reflection, ListsServicesAndGivesTheirFilesInOneCall) {
  const Embedded embedded;
  RawStream stream(embedded.channel, kReflection);
  ASSERT_TRUE(stream.Write(LengthDelimited(7, "*")));
  const std::string list = stream.Read().value_or("");
  EXPECT_EQ(FieldsOf(list, 2), std::vector<std::string>{LengthDelimited(7, "*")});
  for (const char* name : {"ModelService", "AnalysisService", "ToolpathService"}) {
    EXPECT_THAT(FieldsOf(list, 6), ::testing::ElementsAre(HasSubstr(std::string("patchmill.v1.") + name)));
  }
  ASSERT_TRUE(stream.Write(LengthDelimited(4, "patchmill.v1.ModelService")));
  const std::vector<std::string> answer = FieldsOf(stream.Read().value_or(""), 4);
  ASSERT_EQ(answer.size(), 1u);
  std::vector<std::string> files;
  for (const std::string& bytes : FieldsOf(answer.front(), 1)) {
    google::protobuf::FileDescriptorProto file;
    EXPECT_TRUE(file.ParseFromString(bytes));
    files.push_back(file.name());
  }
  EXPECT_THAT(files,
              ::testing::IsSupersetOf({"patchmill/v1/model_service.proto", "patchmill/v1/model.proto"}));
  ASSERT_TRUE(stream.Write(LengthDelimited(3, "no/such.proto")));
  EXPECT_THAT(FieldsOf(stream.Read().value_or(""), 7), ::testing::ElementsAre(HasSubstr("not known")));
  EXPECT_TRUE(stream.End().ok());
}

}  // namespace
}  // namespace patchmill
