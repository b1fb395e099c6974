// Small requests that ask for much, and many at once: refused with a reason, before their cost is paid.
#include <chrono>
#include <future>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "server/limits.h"
#include "tests/service/embedded.h"
#include "tests/service/raw_stub.h"
#include "tests/service/requests.h"
#include "tests/service/status_matchers.h"
#include "tests/support/sanitized.h"

namespace patchmill {
namespace {

using namespace std::chrono_literals;
using grpc::StatusCode;
using testing::BombOfOperations;
using testing::CallWithBytes;
using testing::Embedded;
using ::testing::HasSubstr;
using testing::InfoOf;
using testing::kCheckModel;
using testing::kGenerateProgram;
using testing::LengthDelimited;
using testing::Repeated;
using testing::RpcStatusIs;

double PeakMib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

// Seven million operations would be 700 MiB.
TEST(RequestLimits, ListsAreCountedBeforeTheyAreParsed) {
  Embedded embedded;
  const std::string bomb = BombOfOperations(7'000'000);
  const double before = PeakMib();
  const grpc::Status status = CallWithBytes(embedded.channel, kGenerateProgram, bomb);
  EXPECT_THAT(status, RpcStatusIs(StatusCode::RESOURCE_EXHAUSTED, HasSubstr("job.operations = 100001")));
  EXPECT_EQ(InfoOf(status).reason(), "LIMIT_EXCEEDED");
  EXPECT_EQ(InfoOf(status).limit(), "job.operations");
  EXPECT_EQ(InfoOf(status).limit_value(), 100'000);
  EXPECT_LT(PeakMib() - before, testing::kSanitized ? 400.0 : 150.0);
}

TEST(RequestLimits, PackedNumbersAndUnknownFieldsAreCountedToo) {
  Embedded embedded;
  const std::string numbers = LengthDelimited(3, std::string(20'000'000, 1));  // patch indices
  const grpc::Status many =
      CallWithBytes(embedded.channel, "/patchmill.v1.AnalysisService/EvaluateSurface", numbers);
  EXPECT_EQ(many.error_code(), StatusCode::RESOURCE_EXHAUSTED) << many.error_message();
  const grpc::Status unknown =
      CallWithBytes(embedded.channel, kCheckModel, Repeated(std::string("\xF8\x07\x00", 3), 15'000'000));
  EXPECT_THAT(unknown, RpcStatusIs(StatusCode::RESOURCE_EXHAUSTED, HasSubstr("message_memory_bytes")));
}

// A message in a file is one more message.
TEST(RequestLimits, MessagesInModelFilesAreCountedToo) {
  Embedded embedded;
  v1::CheckModelRequest request;
  v1::ModelFile& file = *request.mutable_source()->mutable_file();
  v1::CheckModelResponse response;
  file.set_content(Repeated(std::string("\x12\x00", 2), 7'000'000));
  EXPECT_THAT(
      embedded.Check(request, &response),
      RpcStatusIs(StatusCode::RESOURCE_EXHAUSTED, HasSubstr("patches = 100001; the limit is 100000")));
  file.set_content(R"({"patches": [)" + Repeated("{},", 300'000) + "{}]}");
  EXPECT_THAT(
      embedded.Check(request, &response),
      RpcStatusIs(StatusCode::RESOURCE_EXHAUSTED, HasSubstr("patches = 100001; the limit is 100000")));
  file.set_content(R"({"patches": [)" + Repeated("{},", 4'000'000) + "{}]}");
  EXPECT_THAT(embedded.Check(request, &response),
              RpcStatusIs(StatusCode::RESOURCE_EXHAUSTED, HasSubstr("model.json_object_count = 4000002")));
}

TEST(RequestLimits, BytesThatAreNoRequestAreUnreadable) {
  Embedded embedded;
  for (const std::string& bytes : {std::string("\x0A\x7F", 2), std::string("no request at all")}) {
    const grpc::Status status = CallWithBytes(embedded.channel, kCheckModel, bytes);
    EXPECT_THAT(status, RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("cannot be read")));
    EXPECT_EQ(InfoOf(status).reason(), "REQUEST_UNREADABLE");
  }
  // A text that is not UTF-8: only the parser sees that.
  const grpc::Status text = CallWithBytes(embedded.channel, kGenerateProgram, LengthDelimited(5, "\xFF\xFE"));
  EXPECT_EQ(InfoOf(text).reason(), "REQUEST_UNREADABLE") << text.error_message();
}

// 1 GiB of zeros is 1 MiB on the wire.
TEST(RequestLimits, PackedRequestsAreRefusedBeforeTheyAreUnpacked) {
  Embedded over_port = testing::EmbeddedOnAPort();
  testing::RawCallOptions options;
  for (const auto algorithm : {GRPC_COMPRESS_GZIP, GRPC_COMPRESS_DEFLATE}) {
    options.compression = algorithm;
    EXPECT_EQ(CallWithBytes(over_port.channel, kCheckModel, std::string(1 << 20, '\0'), options).error_code(),
              StatusCode::UNIMPLEMENTED);
  }
}

// A request with a file of `mib` of padding.
v1::CheckModelRequest Padded(int mib) {
  v1::CheckModelRequest request;
  request.mutable_source()->mutable_file()->set_format("json");
  request.mutable_source()->mutable_file()->set_content(
      std::string(static_cast<std::size_t>(mib) << 20, ' '));
  return request;
}

TEST(BytesInFlight, ARunningCallHoldsWhatItWasSent) {
  ServerOptions options;
  options.max_in_flight_mib = 8;
  Embedded embedded(options);
  v1::CheckModelResponse response;
  EXPECT_EQ(InfoOf(embedded.Check(Padded(3), &response)).reason(), "MODEL_UNREADABLE");
  const grpc::Status alone = embedded.Check(Padded(9), &response);
  EXPECT_THAT(alone, RpcStatusIs(StatusCode::RESOURCE_EXHAUSTED, HasSubstr("request_bytes_in_flight")));
  EXPECT_EQ(InfoOf(alone).reason(), "LIMIT_EXCEEDED");

  v1::GenerateProgramRequest held = testing::LongRequest();
  std::string json;
  {
    google::protobuf::util::JsonPrintOptions print;
    print.preserve_proto_field_names = true;
    ASSERT_TRUE(google::protobuf::util::MessageToJsonString(held.job().source().model(), &json, print).ok());
  }
  v1::ModelFile& file = *held.mutable_job()->mutable_source()->mutable_file();
  file.set_format("json");
  file.set_content(json + std::string(std::size_t{3} << 20, ' '));
  grpc::ClientContext context;
  const auto reader = embedded.toolpath->GenerateProgram(&context, held);
  v1::GenerateProgramResponse event;
  ASSERT_TRUE(reader->Read(&event)) << reader->Finish().error_message();
  const grpc::Status refused = embedded.Check(Padded(3), &response);
  EXPECT_THAT(refused, RpcStatusIs(StatusCode::RESOURCE_EXHAUSTED, HasSubstr("try again later")));
  EXPECT_EQ(InfoOf(refused).reason(), "TOO_MANY_BYTES");
  EXPECT_EQ(InfoOf(refused).limit(), "request_bytes_in_flight");
  EXPECT_EQ(InfoOf(refused).limit_value(), 8 << 20);
  v1::CheckModelRequest small;
  *small.mutable_source()->mutable_model() = testing::Bump();
  EXPECT_TRUE(embedded.Check(small, &response).ok());  // there is room for that
  context.TryCancel();
  while (reader->Read(&event)) {
  }
  reader->Finish();
  std::string reason;
  for (int k = 0; k < 200 && reason != "MODEL_UNREADABLE"; ++k) {
    reason = InfoOf(embedded.Check(Padded(3), &response)).reason();
    std::this_thread::sleep_for(20ms);
  }
  EXPECT_EQ(reason, "MODEL_UNREADABLE");
}

TEST(BytesInFlight, ManyAtOnceAreRefusedWithAReasonAndLeaveNothingHeld) {
  ServerOptions options;
  options.max_in_flight_mib = 16;
  options.max_jobs = 64;
  Embedded embedded(options);
  std::vector<std::future<grpc::Status>> calls;
  for (int k = 0; k < 12; ++k) {
    calls.push_back(std::async(std::launch::async, [&] {
      v1::CheckModelResponse response;
      return embedded.Check(Padded(6), &response);
    }));
  }
  for (auto& call : calls) {
    const std::string reason = InfoOf(call.get()).reason();
    EXPECT_TRUE(reason == "MODEL_UNREADABLE" || reason == "TOO_MANY_BYTES") << reason;
  }
  v1::CheckModelResponse response;
  EXPECT_EQ(InfoOf(embedded.Check(Padded(6), &response)).reason(), "MODEL_UNREADABLE");
}

// Calls that never send their request hold neither a job's place nor a thread.
TEST(BytesInFlight, CallsWithoutARequestDoNotKeepOthersOut) {
  ServerOptions options;
  options.max_jobs = 1;
  Embedded embedded(options);
  grpc::TemplatedGenericStub<grpc::ByteBuffer, grpc::ByteBuffer> stub(embedded.channel);
  grpc::CompletionQueue queue;
  std::vector<std::unique_ptr<grpc::ClientContext>> contexts;
  std::vector<std::unique_ptr<grpc::GenericClientAsyncReaderWriter>> silent;
  void* tag = nullptr;
  bool ok = false;
  for (int k = 0; k < 20; ++k) {
    contexts.push_back(std::make_unique<grpc::ClientContext>());
    silent.push_back(stub.PrepareCall(contexts.back().get(), kCheckModel, &queue));
    silent.back()->StartCall(nullptr);
    queue.Next(&tag, &ok);
  }
  v1::CheckModelRequest request;
  *request.mutable_source()->mutable_model() = testing::Bump();
  v1::CheckModelResponse response;
  EXPECT_TRUE(embedded.Check(request, &response).ok());
  // A call that ends without a request gets an error that says so.
  silent[0]->WritesDone(nullptr);
  queue.Next(&tag, &ok);
  grpc::Status status;
  silent[0]->Finish(&status, nullptr);
  queue.Next(&tag, &ok);
  EXPECT_EQ(InfoOf(status).reason(), "REQUEST_UNREADABLE");
  for (std::size_t k = 1; k < silent.size(); ++k) {
    contexts[k]->TryCancel();
    silent[k]->Finish(&status, nullptr);
    queue.Next(&tag, &ok);
  }
}

}  // namespace
}  // namespace patchmill
