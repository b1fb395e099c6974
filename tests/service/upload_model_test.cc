// Models that are uploaded once and named by their digest, and answers that are kept.
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include "core/base/digest.h"
#include "server/limits.h"
#include "tests/service/embedded.h"
#include "tests/service/requests.h"
#include "tests/service/status_matchers.h"
#include "tests/support/files.h"

namespace patchmill {
namespace {

using grpc::StatusCode;
using testing::BumpJob;
using testing::Embedded;
using testing::EmbeddedOnAPort;
using ::testing::HasSubstr;
using testing::InfoOf;
using testing::RpcStatusIs;

struct Uploaded {
  grpc::Status status;
  v1::UploadModelResponse response;
};

v1::UploadStart StartOf(const std::string& content, const std::string& format) {
  v1::UploadStart start;
  start.set_size_bytes(static_cast<std::int64_t>(content.size()));
  start.set_content_sha256(Sha256(content));
  start.set_format(format);
  return start;
}

Uploaded Upload(const Embedded& embedded, const v1::UploadStart& start,
                const std::vector<std::string>& chunks) {
  Uploaded uploaded;
  grpc::ClientContext context;
  const auto writer = embedded.model->UploadModel(&context, &uploaded.response);
  v1::UploadModelRequest message;
  *message.mutable_start() = start;
  writer->Write(message);
  for (const std::string& chunk : chunks) {
    message.set_chunk(chunk);
    if (!writer->Write(message)) break;
  }
  writer->WritesDone();
  uploaded.status = writer->Finish();
  return uploaded;
}

std::vector<std::string> InChunks(const std::string& content, std::size_t size) {
  std::vector<std::string> chunks;
  for (std::size_t at = 0; at < content.size(); at += size) chunks.push_back(content.substr(at, size));
  return chunks;
}

v1::GenerateProgramRequest TeapotRequest(const std::string& content) {
  v1::GenerateProgramRequest request;
  *request.mutable_job() = BumpJob();
  v1::ModelFile& file = *request.mutable_job()->mutable_source()->mutable_file();
  file.set_format("bpt");
  file.set_content(content);
  request.mutable_job()->mutable_operations(0)->clear_heights();
  request.mutable_job()->mutable_operations(0)->set_scallop_mm(0.3);
  request.mutable_job()->mutable_operations(0)->set_tolerance_mm(0.05);
  request.mutable_job()->mutable_setup()->set_scale(50.0);
  request.mutable_job()->mutable_setup()->set_up(v1::UP_AXIS_Y);
  request.add_outputs(v1::OUTPUT_PROGRAM);
  return request;
}

class UploadModelTest : public ::testing::Test {
 protected:
  Embedded embedded_ = EmbeddedOnAPort();
  const std::string content_ = testing::ReadRepositoryFile("examples/teapot.bpt");
};

TEST_F(UploadModelTest, AJobByDigestHasTheBytesOfTheJobWithTheModel) {
  const Uploaded uploaded = Upload(embedded_, StartOf(content_, "bpt"), InChunks(content_, 1000));
  ASSERT_TRUE(uploaded.status.ok()) << uploaded.status.error_message();
  EXPECT_EQ(uploaded.response.model_sha256().size(), 32u);
  EXPECT_GT(uploaded.response.patch_count(), 0);
  v1::GenerateProgramRequest request = TeapotRequest(content_);
  const auto inline_job = embedded_.Generate(request);
  ASSERT_TRUE(inline_job.status.ok()) << inline_job.status.error_message();
  ASSERT_NE(inline_job.Program(), "");
  request.mutable_job()->mutable_source()->set_model_sha256(uploaded.response.model_sha256());
  const auto by_digest = embedded_.Generate(request);
  ASSERT_TRUE(by_digest.status.ok()) << by_digest.status.error_message();
  EXPECT_EQ(by_digest.Program(), inline_job.Program());

  v1::CheckModelRequest check;
  check.mutable_source()->set_model_sha256(uploaded.response.model_sha256());
  v1::CheckModelResponse checked;
  ASSERT_TRUE(embedded_.Check(check, &checked).ok());
  EXPECT_EQ(checked.model_sha256(), uploaded.response.model_sha256());
}

TEST_F(UploadModelTest, WhatIsForgottenIsNotFound) {
  const Uploaded uploaded = Upload(embedded_, StartOf(content_, "bpt"), {content_});
  v1::ForgetModelRequest forget;
  forget.set_model_sha256(uploaded.response.model_sha256());
  for (const bool there : {true, false}) {
    v1::ForgetModelResponse response;
    grpc::ClientContext context;
    ASSERT_TRUE(embedded_.model->ForgetModel(&context, forget, &response).ok());
    EXPECT_EQ(response.was_there(), there);
  }
  v1::CheckModelRequest check;
  check.mutable_source()->set_model_sha256(uploaded.response.model_sha256());
  v1::CheckModelResponse response;
  const grpc::Status status = embedded_.Check(check, &response);
  EXPECT_EQ(status.error_code(), StatusCode::NOT_FOUND);
  EXPECT_EQ(InfoOf(status).reason(), "MODEL_NOT_CACHED");
  forget.set_model_sha256("short");
  v1::ForgetModelResponse answer;
  grpc::ClientContext context;
  EXPECT_THAT(embedded_.model->ForgetModel(&context, forget, &answer),
              RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("model_sha256 has 5 bytes; must have 32")));
}

TEST_F(UploadModelTest, AWrongUploadSaysWhatIsWrong) {
  v1::UploadStart start = StartOf(content_, "bpt");
  EXPECT_THAT(Upload(embedded_, start, {content_.substr(0, 100)}).status,
              RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("chunk is missing: 100 of ")));
  EXPECT_THAT(Upload(embedded_, start, {content_ + "x"}).status,
              RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("must have at most")));
  EXPECT_THAT(Upload(embedded_, start, {content_, "x"}).status,
              RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("follows the last byte")));
  std::string damaged = content_;
  damaged[10] ^= 1;
  EXPECT_THAT(Upload(embedded_, start, {damaged}).status,
              RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("start.content_sha256 is not that")));
  start.set_content_sha256("x");
  start.set_size_bytes(0);
  const grpc::Status two = Upload(embedded_, start, {}).status;
  EXPECT_EQ(InfoOf(two).violation_count(), 2);
  start = StartOf(content_, "bpt");
  start.set_size_bytes(static_cast<std::int64_t>(limits::kMaxUploadBytes) + 1);
  const grpc::Status large = Upload(embedded_, start, {}).status;
  EXPECT_EQ(InfoOf(large).reason(), "LIMIT_EXCEEDED");
  EXPECT_EQ(InfoOf(large).limit(), "upload_bytes");
  EXPECT_THAT(Upload(embedded_, StartOf("no model", "bpt"), {"no model"}).status,
              RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("model file")));
  EXPECT_THAT(Upload(embedded_, StartOf(content_, "xyz"), {content_}).status,
              RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("format")));
}

TEST_F(UploadModelTest, AModelThatCannotBeUsedIsNotKept) {
  const std::string json = R"({"lengthUnit":"LENGTH_UNIT_MILLIMETER","patches":[{"bezier":{"degreeU":99}}]})";
  const Uploaded uploaded = Upload(embedded_, StartOf(json, "json"), {json});
  ASSERT_TRUE(uploaded.status.ok()) << uploaded.status.error_message();
  EXPECT_EQ(uploaded.response.model_sha256(), "");
  ASSERT_GE(uploaded.response.diagnostics_size(), 1);
  EXPECT_EQ(uploaded.response.diagnostics(0).severity(), v1::SEVERITY_ERROR);
}

// A file that fits the limit comes through, though no single message could hold it.
TEST_F(UploadModelTest, AFileMayBeLargerThanAMessage) {
  const std::string json =
      R"({"lengthUnit":"LENGTH_UNIT_MILLIMETER","patches":[{"bezier":{"degreeU":1,"degreeV":1,)"
      R"("points":[0,0,0,0,9,0,9,0,0,9,9,1]}}]})";
  const std::string large = json + std::string(std::size_t{140} << 20, ' ');
  const Uploaded uploaded = Upload(embedded_, StartOf(large, "json"), InChunks(large, std::size_t{4} << 20));
  ASSERT_TRUE(uploaded.status.ok()) << uploaded.status.error_message();
  EXPECT_EQ(uploaded.response.patch_count(), 1);
}

// A model is never taken and then not there.
TEST(UploadModel, AStoreThatIsTooSmallIsNamed) {
  ServerOptions options;
  options.listen = "127.0.0.1:0";
  options.log_requests = false;
  options.store_mib = 0;
  auto started = StartServer(options);
  ASSERT_TRUE(started.ok());
  const std::string target = "127.0.0.1:" + std::to_string((*started)->port());
  const Embedded embedded(*std::move(started), target);
  const std::string content = testing::ReadRepositoryFile("examples/teapot.bpt");
  const grpc::Status status = Upload(embedded, StartOf(content, "bpt"), {content}).status;
  EXPECT_THAT(status, RpcStatusIs(StatusCode::RESOURCE_EXHAUSTED, HasSubstr("--store-mib")));
  EXPECT_EQ(InfoOf(status).limit(), "stored_model_bytes");
}

// A network can be edited by its digest, and a model of patches cannot.
TEST_F(UploadModelTest, ANetworkIsKeptAsOne) {
  const std::string network = testing::ReadRepositoryFile("examples/mouse.json");
  const Uploaded uploaded = Upload(embedded_, StartOf(network, "json"), {network});
  ASSERT_TRUE(uploaded.status.ok()) << uploaded.status.error_message();
  v1::EditModelRequest edit;
  edit.mutable_source()->set_model_sha256(uploaded.response.model_sha256());
  v1::EditModelResponse edited;
  {
    grpc::ClientContext context;
    const grpc::Status status = embedded_.model->EditModel(&context, edit, &edited);
    ASSERT_TRUE(status.ok()) << status.error_message();
    EXPECT_TRUE(edited.model().has_network());
  }
  const Uploaded patches = Upload(embedded_, StartOf(content_, "bpt"), {content_});
  edit.mutable_source()->set_model_sha256(patches.response.model_sha256());
  grpc::ClientContext context;
  EXPECT_THAT(embedded_.model->EditModel(&context, edit, &edited),
              RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("names a model of patches")));
}

// The same request again has the same answer at once; what the answer does not depend on does not count.
TEST_F(UploadModelTest, AKeptAnswerIsTheSame) {
  v1::GenerateProgramRequest request = TeapotRequest(content_);
  const auto first = embedded_.Generate(request);
  ASSERT_TRUE(first.status.ok());
  request.set_request_id("again");
  request.set_max_threads(1);
  const auto begin = std::chrono::steady_clock::now();
  const auto second = embedded_.Generate(request);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  ASSERT_TRUE(second.status.ok());
  EXPECT_LT(took.count(), 0.1);  // the job takes longer
  EXPECT_EQ(first.Program(), second.Program());
  ASSERT_NE(second.Report(), nullptr);
  EXPECT_EQ(first.Report()->SerializeAsString(), second.Report()->SerializeAsString());
}

// The same values, first from a file without a unit, then with its unit stated: the answer that was kept with
// the findings of the first upload is not given for the second.
TEST_F(UploadModelTest, FindingsAreThoseOfTheNewestUpload) {
  v1::UploadStart start = StartOf(content_, "bpt");
  const Uploaded unitless = Upload(embedded_, start, {content_});
  v1::GenerateProgramRequest request = TeapotRequest(content_);
  request.mutable_job()->mutable_source()->set_model_sha256(unitless.response.model_sha256());
  // The model is small beside this ball. That is suspicious as long as nobody has stated its unit.
  request.mutable_job()->mutable_operations(0)->mutable_tool()->mutable_ball_end()->set_diameter_mm(50.0);
  const auto suspects_unit = [&] {
    const auto stream = embedded_.Generate(request);
    EXPECT_TRUE(stream.status.ok()) << stream.status.error_message();
    const auto& findings = stream.Report()->diagnostics();
    return std::any_of(findings.begin(), findings.end(),
                       [](const v1::Diagnostic& d) { return d.code() == "SUSPICIOUS_SIZE"; });
  };
  EXPECT_TRUE(suspects_unit());
  start.set_length_unit(v1::LENGTH_UNIT_MILLIMETER);
  const Uploaded stated = Upload(embedded_, start, {content_});
  EXPECT_EQ(stated.response.model_sha256(), unitless.response.model_sha256());
  EXPECT_FALSE(suspects_unit());
}

// What an answer does not depend on is judged nevertheless, while the same job runs and after its end.
TEST_F(UploadModelTest, AWrongRequestGetsNoAnswerOfARightOne) {
  v1::GenerateProgramRequest request = TeapotRequest(content_);
  const auto is_refused = [&] {
    v1::GenerateProgramRequest wrong = request;
    wrong.set_request_id("two\nlines");
    EXPECT_THAT(embedded_.Generate(wrong).status,
                RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("request_id")));
    wrong.set_request_id("one line");
    wrong.set_max_threads(-1);
    EXPECT_THAT(embedded_.Generate(wrong).status,
                RpcStatusIs(StatusCode::INVALID_ARGUMENT, HasSubstr("max_threads")));
  };
  Embedded::Stream right;
  std::thread job([&] { right = embedded_.Generate(request); });
  for (int k = 0; k < 5; ++k) is_refused();
  job.join();
  EXPECT_TRUE(right.status.ok()) << right.status.error_message();
  is_refused();
}

// Two at once: one job, one answer.
TEST_F(UploadModelTest, ARunningJobIsJoined) {
  v1::GenerateProgramRequest request = TeapotRequest(content_);
  request.mutable_job()->set_name("joined");
  std::vector<Embedded::Stream> streams(4);
  std::vector<std::thread> threads;
  for (Embedded::Stream& stream : streams)
    threads.emplace_back([&] { stream = embedded_.Generate(request); });
  for (std::thread& thread : threads) thread.join();
  for (const Embedded::Stream& stream : streams) {
    ASSERT_TRUE(stream.status.ok()) << stream.status.error_message();
    EXPECT_EQ(stream.Report()->SerializeAsString(), streams[0].Report()->SerializeAsString());
    EXPECT_EQ(stream.Program(), streams[0].Program());
  }
}

}  // namespace
}  // namespace patchmill
