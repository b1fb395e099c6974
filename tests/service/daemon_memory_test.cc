// The memory of the process stays below its limit, whatever jobs need.
#include <future>
#include <vector>

#include <gmock/gmock.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include "patchmill/v1/toolpath_service.grpc.pb.h"
#include "tests/service/daemon.h"
#include "tests/service/raw_stub.h"
#include "tests/service/requests.h"
#include "tests/service/status_matchers.h"
#include "tests/support/sanitized.h"

namespace patchmill {
namespace {

using grpc::StatusCode;
using testing::Daemon;
using testing::InfoOf;

const std::string kDaemon = PATCHMILL_BIN "/patchmilld";

struct Ended {
  grpc::Status status;
  bool accepted = false, report = false;
};

Ended Generate(const Daemon& daemon, const v1::GenerateProgramRequest& request) {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  const auto channel =
      grpc::CreateCustomChannel(daemon.target(), grpc::InsecureChannelCredentials(), arguments);
  const auto stub = v1::ToolpathService::NewStub(channel);
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(120));
  const auto reader = stub->GenerateProgram(&context, request);
  Ended ended;
  v1::GenerateProgramResponse event;
  while (reader->Read(&event)) {
    ended.accepted |= event.has_accepted();
    ended.report |= event.has_report();
  }
  ended.status = reader->Finish();
  return ended;
}

// A job of some GiB: a plate with passes at the finest step.
v1::GenerateProgramRequest Large(double size) {
  v1::GenerateProgramRequest request = testing::BumpRequest(size);
  v1::Operation& op = *request.mutable_job()->mutable_operations(0);
  op.mutable_tool()->mutable_ball_end()->set_diameter_mm(2.0);
  op.set_scallop_mm(0.002);
  op.set_tolerance_mm(0.002);
  return request;
}

// Four jobs, each of which needs more than there is, with estimates that are ten times too low.
TEST(DaemonMemory, JobsThatOutgrowItAreEndedAndTheServerLives) {
  if (testing::kSanitized) GTEST_SKIP() << "a sanitizer has an allocator of its own, which counts nothing";
  Daemon daemon(kDaemon, {"--memory-limit", "1024", "--max-jobs", "4", "--estimate-factor", "0.1",
                          "--store-mib", "64", "--max-in-flight-mib", "64"});
  std::vector<std::future<Ended>> jobs;
  for (int k = 0; k < 4; ++k) {
    jobs.push_back(std::async(std::launch::async, [&, k] { return Generate(daemon, Large(300.0 + k)); }));
  }
  int outgrown = 0;
  for (auto& job : jobs) {
    const Ended ended = job.get();
    if (ended.status.ok()) {
      EXPECT_TRUE(ended.report);
      continue;
    }
    EXPECT_EQ(ended.status.error_code(), StatusCode::RESOURCE_EXHAUSTED) << ended.status.error_message();
    const std::string limit = InfoOf(ended.status).limit();
    EXPECT_TRUE(limit == "job_memory_bytes" || limit == "memory_of_all_jobs_bytes") << limit;
    outgrown += limit == "job_memory_bytes";
  }
  EXPECT_GE(outgrown, 1);
  EXPECT_LT(daemon.PeakMib(), 1024.0);
  // What they had is free again.
  const Ended small = Generate(daemon, testing::BumpRequest());
  EXPECT_TRUE(small.status.ok()) << small.status.error_message();
  EXPECT_TRUE(small.report);
  daemon.process().Signal(SIGTERM);
  EXPECT_EQ(daemon.process().Wait(), 0);
}

// The estimate is stated, and a job that never fits is refused before it starts.
TEST(DaemonMemory, AJobThatNeverFitsIsRefusedAtOnce) {
  Daemon daemon(kDaemon, {"--memory-limit", "256", "--store-mib", "0"});
  const Ended ended = Generate(daemon, Large(2000.0));
  EXPECT_EQ(ended.status.error_code(), StatusCode::RESOURCE_EXHAUSTED) << ended.status.error_message();
  EXPECT_EQ(InfoOf(ended.status).limit(), "estimated_job_memory_bytes");
  EXPECT_TRUE(ended.accepted);
}

}  // namespace
}  // namespace patchmill
