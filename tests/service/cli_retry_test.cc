// Servers that are lost, and what the command line does then.
#include <chrono>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <grpcpp/security/server_credentials.h>
#include <grpcpp/server.h>
#include <grpcpp/server_builder.h>
#include <gtest/gtest.h>

#include "patchmill/v1/toolpath_service.grpc.pb.h"
#include "server/errors.h"
#include "tests/service/patchmill.h"
#include "tests/service/requests.h"

namespace patchmill {
namespace {

using testing::Finished;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Patchmill;
using testing::Slurp;
using testing::TempDir;

constexpr const char* kProgram = "G21\nM30\n";

// Answers one call after the other with these, and every later one with a whole program.
class Troubled final : public v1::ToolpathService::Service {
 public:
  explicit Troubled(std::vector<grpc::Status> troubles) : troubles_(std::move(troubles)) {
    grpc::ServerBuilder builder;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port_);
    builder.RegisterService(this);
    server_ = builder.BuildAndStart();
  }

  Finished Mill(const TempDir& dir, const std::vector<std::string>& more = {}) {
    const std::string model = dir.Write("bump.pb", testing::Bump().SerializeAsString());
    std::vector<std::string> words = {"mill",           model,      "-o",
                                      dir / "part.ngc", "--server", fmt::format("127.0.0.1:{}", port_)};
    words.insert(words.end(), more.begin(), more.end());
    return Patchmill(words);
  }
  int call_count() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return static_cast<int>(requests_.size());
  }
  // The names and the bytes of all calls.
  std::set<std::string> names() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return {names_.begin(), names_.end()};
  }
  std::set<std::string> requests() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return {requests_.begin(), requests_.end()};
  }

 private:
  grpc::Status GenerateProgram(grpc::ServerContext* context, const v1::GenerateProgramRequest* request,
                               grpc::ServerWriter<v1::GenerateProgramResponse>* writer) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    const std::size_t call = requests_.size();
    requests_.push_back(request->SerializeAsString());
    const auto name = context->client_metadata().find("x-request-id");
    names_.push_back(name == context->client_metadata().end()
                         ? ""
                         : std::string(name->second.data(), name->second.size()));
    v1::GenerateProgramResponse chunk, report;
    if (call < troubles_.size()) {
      // A part of the program has come when the server is lost.
      chunk.mutable_program()->set_data("G20\n");
      if (troubles_[call].error_details().empty()) writer->Write(chunk);
      return troubles_[call];
    }
    chunk.mutable_program()->set_data(kProgram);
    report.mutable_report()->set_outcome(v1::OUTCOME_COMPLETE);
    report.mutable_report()->set_program_size_bytes(static_cast<int>(std::string(kProgram).size()));
    writer->Write(chunk);
    writer->Write(report);
    return grpc::Status::OK;
  }

  const std::vector<grpc::Status> troubles_;
  std::mutex mutex_;
  std::vector<std::string> requests_, names_;
  int port_ = 0;
  std::unique_ptr<grpc::Server> server_;
};

const grpc::Status kBroken(grpc::StatusCode::UNAVAILABLE, "Socket closed");
const grpc::Status kReset(grpc::StatusCode::INTERNAL, "Received RST_STREAM with error code 2");

TEST(CliRetry, ALostJobIsAskedForAgainUnderTheSameName) {
  const TempDir dir;
  Troubled server({kBroken, kReset});
  const Finished run = server.Mill(dir);
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(Slurp(dir / "part.ngc"), kProgram);  // without what the lost servers had sent
  EXPECT_EQ(server.call_count(), 3);
  EXPECT_EQ(server.requests().size(), 1U);
  ASSERT_EQ(server.names().size(), 1U);
  EXPECT_THAT(*server.names().begin(), ::testing::Not(IsEmpty()));
  EXPECT_THAT(run.err, HasSubstr("broke while the call ran: Socket closed; trying again"));
}

TEST(CliRetry, AJobThatEndsItsServersIsGivenUp) {
  const TempDir dir;
  Troubled server({kBroken, kBroken, kBroken, kBroken, kBroken});
  const Finished run = server.Mill(dir, {"--quiet"});
  EXPECT_EQ(run.status, 1);
  EXPECT_EQ(server.call_count(), 3);
  EXPECT_THAT(run.err, HasSubstr("broke while the call ran: Socket closed"));
  EXPECT_THAT(run.err, ::testing::Not(HasSubstr("trying again")));
  EXPECT_THAT(dir.Names(), ::testing::ElementsAre("bump.pb"));
}

TEST(CliRetry, AServerThatDrainsIsAskedUntilAnotherOneAnswers) {
  const TempDir dir;
  const grpc::Status draining = ToGrpcStatus(DrainingError());
  Troubled server({draining, draining, draining});
  const Finished run = server.Mill(dir);
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(server.call_count(), 4);  // more than a call that breaks has
}

TEST(CliRetry, TimeoutBoundsAllTriesTogether) {
  const TempDir dir;
  Troubled server(std::vector<grpc::Status>(100, ToGrpcStatus(DrainingError())));
  const auto begin = std::chrono::steady_clock::now();
  const Finished run = server.Mill(dir, {"--timeout", "1.2"});
  EXPECT_EQ(run.status, 1);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(4));
  EXPECT_GE(server.call_count(), 2);
  EXPECT_THAT(run.err, HasSubstr("shutting down"));
}

TEST(CliRetry, WhatTheServerAnswersIsNoLoss) {
  for (const absl::Status& answer : {LimitError("x", 1.0, 2.0), absl::InternalError("a fault"),
                                     TooManyJobsError(1, 0), absl::InvalidArgumentError("wrong")}) {
    const TempDir dir;
    Troubled server({ToGrpcStatus(answer)});
    EXPECT_NE(server.Mill(dir).status, 0);
    EXPECT_EQ(server.call_count(), 1) << answer;
  }
}

TEST(CliRetry, AnAddressWhereNobodyAnswersIsSaidAtOnce) {
  const TempDir dir;
  const std::string model = dir.Write("bump.pb", testing::Bump().SerializeAsString());
  const auto begin = std::chrono::steady_clock::now();
  const Finished run = Patchmill({"check", model, "--server", "127.0.0.1:1"});
  EXPECT_EQ(run.status, 1);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
  EXPECT_THAT(run.err, HasSubstr("no server answers at 127.0.0.1:1"));
}

TEST(CliRetry, AServerThatEndsTheCallAtItsDeadlineWasTooSlow) {
  const TempDir dir;
  Troubled late({grpc::Status(grpc::StatusCode::CANCELLED, "")}),
      early({grpc::Status(grpc::StatusCode::CANCELLED, "")});
  EXPECT_THAT(late.Mill(dir, {"--timeout", "0.1"}).err, HasSubstr("not done within --timeout 0.1 s"));
  EXPECT_THAT(early.Mill(dir, {"--timeout", "60"}).err, HasSubstr("ended the call"));
}

}  // namespace
}  // namespace patchmill
