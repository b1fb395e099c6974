// The server and its files after the worst: clients and servers that are killed at any moment, a disk that is
// full, and a time of day that jumps.
#include <cstdlib>
#include <filesystem>
#include <future>
#include <random>
#include <thread>

#include <gmock/gmock.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include "patchmill/v1/toolpath_service.grpc.pb.h"
#include "tests/service/daemon.h"
#include "tests/service/requests.h"
#include "tests/service/status_matchers.h"
#include "tests/support/fuzz.h"
#include "tests/support/sanitized.h"

namespace patchmill {
namespace {

using namespace std::chrono_literals;
using grpc::StatusCode;
using testing::Daemon;
using ::testing::EndsWith;
using ::testing::Not;
using testing::Process;
using testing::TempDir;

const std::string kPatchmill = PATCHMILL_BIN "/patchmill";
const std::string kDaemon = PATCHMILL_BIN "/patchmilld";

struct Generated {
  grpc::Status status;
  std::string program;
};

Generated Generate(const Daemon& daemon, const v1::GenerateProgramRequest& request,
                   std::chrono::seconds deadline = 100s) {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  const auto channel =
      grpc::CreateCustomChannel(daemon.target(), grpc::InsecureChannelCredentials(), arguments);
  const auto stub = v1::ToolpathService::NewStub(channel);
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + deadline);
  const auto reader = stub->GenerateProgram(&context, request);
  Generated generated;
  v1::GenerateProgramResponse event;
  while (reader->Read(&event)) generated.program += event.program().data();
  generated.status = reader->Finish();
  return generated;
}

// A job of about half a second.
v1::GenerateProgramRequest Job() {
  v1::GenerateProgramRequest request = testing::BumpRequest(60.0);
  request.mutable_job()->mutable_operations(0)->set_scallop_mm(0.005);
  return request;
}

// The program of `Job`, by a server that nothing happens to.
const std::string& RightProgram() {
  static const std::string program = [] {
    const Daemon daemon(kDaemon);
    const Generated generated = Generate(daemon, Job());
    EXPECT_TRUE(generated.status.ok()) << generated.status.error_message();
    return generated.program;
  }();
  return program;
}

// 50 in the long tests.
int Kills() { return testing::CountOf(5, 50); }

class Moments {
 public:
  void Wait() {
    std::this_thread::sleep_for(std::chrono::milliseconds(std::uniform_int_distribution(0, 700)(random_)));
  }

 private:
  std::mt19937 random_{static_cast<unsigned>(testing::FromEnvironment("PATCHMILL_FUZZ_SEED", 1))};
};

bool IdleWithin(const Daemon& daemon, std::chrono::milliseconds limit) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (std::chrono::steady_clock::now() < end) {
    const double before = daemon.CpuSeconds();
    std::this_thread::sleep_for(100ms);
    if (daemon.CpuSeconds() - before < 0.03) return true;
  }
  return false;
}

TEST(DaemonKills, AClientThatIsKilledLeavesNoWorkBehind) {
  Daemon daemon(kDaemon);
  const TempDir folder;
  Moments moments;
  for (int k = 0; k < Kills(); ++k) {
    Process client({kPatchmill, "mill", PATCHMILL_SOURCE_DIR "/examples/two_hills.json", "--tool-diameter",
                    "2", "--scallop", std::to_string(0.0005 + 1e-6 * k), "--server", daemon.target(), "-o",
                    folder / "out.ngc"});
    moments.Wait();
    client.Signal(SIGKILL);
    client.Wait();
    EXPECT_TRUE(IdleWithin(daemon, testing::kSanitized ? 20s : 2s)) << "kill " << k;
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "out.ngc"));
  EXPECT_EQ(Generate(daemon, Job()).program, RightProgram());
  daemon.process().Signal(SIGTERM);
  EXPECT_EQ(daemon.process().Wait(), 0);
}

// Each server has the cache of the one before it. The client learns of it, or has the whole answer.
TEST(DaemonKills, AServerThatIsKilledLeavesACacheOfWholeAnswers) {
  const TempDir cache;
  Moments moments;
  int lost = 0;
  for (int k = 0; k < Kills(); ++k) {
    Daemon daemon(kDaemon, {"--cache-dir", cache / "answers"});
    v1::GenerateProgramRequest request = Job();
    if (k % 2 == 0) request.mutable_job()->set_name("part " + std::to_string(k));
    auto answer = std::async(std::launch::async, [&] { return Generate(daemon, request); });
    moments.Wait();
    daemon.process().Signal(SIGKILL);
    const Generated generated = answer.get();
    if (generated.status.ok()) {
      if (k % 2 != 0) {
        EXPECT_EQ(generated.program, RightProgram());
      }
    } else {
      EXPECT_EQ(generated.status.error_code(), StatusCode::UNAVAILABLE) << generated.status.error_message();
      ++lost;
    }
    daemon.process().Wait();
  }
  EXPECT_GT(lost, 0);
  for (const bool again : {false, true}) {
    Daemon daemon(kDaemon, {"--cache-dir", cache / "answers"});
    EXPECT_EQ(Generate(daemon, Job()).program, RightProgram()) << again;
    EXPECT_THAT(daemon.process().Err(), Not(::testing::HasSubstr("damaged")));
  }
}

// No file may have more than 4 KiB: as on a full disk, the answer cannot be kept. It is given nevertheless.
TEST(DaemonKills, AFullDiskCostsOnlyTheCache) {
  const TempDir cache;
  Daemon daemon(kDaemon, {"--cache-dir", cache / "answers"}, "ulimit -f 4");
  for (int k = 0; k < 3; ++k) EXPECT_EQ(Generate(daemon, Job()).program, RightProgram());
  EXPECT_TRUE(std::filesystem::is_empty(cache / "answers"));
  daemon.process().Signal(SIGTERM);
  EXPECT_EQ(daemon.process().Wait(), 0);
}

// The server's time of day jumps by ten years and back by a day, while it works and while a job waits.
TEST(DaemonKills, AClockThatJumpsChangesNothing) {
  if (testing::kSanitized) GTEST_SKIP() << "a sanitizer wants to be the first library";
  const std::string library = "/usr/lib/x86_64-linux-gnu/faketime/libfaketimeMT.so.1";
  if (!std::filesystem::exists(library)) GTEST_SKIP() << "scripts/setup.sh installs libfaketime";
  const TempDir folder;
  const std::string clock = folder.Write("clock", "+0");
  Daemon daemon(kDaemon, {"--max-jobs", "1", "--cache-dir", folder / "answers"},
                "export FAKETIME_TIMESTAMP_FILE=" + clock +
                    " FAKETIME_NO_CACHE=1 FAKETIME_DONT_FAKE_MONOTONIC=1 LD_PRELOAD=" + library);
  for (const std::string jump : {"+3650d", "-1d"}) {
    std::vector<std::future<Generated>> jobs;
    for (int k = 0; k < 2; ++k) {
      v1::GenerateProgramRequest request = Job();
      request.mutable_job()->set_name(jump + std::to_string(k));
      jobs.push_back(
          std::async(std::launch::async, [&daemon, request] { return Generate(daemon, request); }));
    }
    std::this_thread::sleep_for(200ms);
    std::ofstream(clock) << jump;
    for (auto& job : jobs) {
      const Generated generated = job.get();
      EXPECT_TRUE(generated.status.ok()) << jump << ": " << generated.status.error_message();
    }
    EXPECT_EQ(Generate(daemon, Job()).program, RightProgram()) << jump;
    // A deadline is a span of time.
    v1::GenerateProgramRequest longer = testing::LongRequest();
    longer.mutable_job()->set_name(jump);
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(Generate(daemon, longer, 1s).status.error_code(), StatusCode::DEADLINE_EXCEEDED) << jump;
    EXPECT_LT(std::chrono::steady_clock::now() - begin, 5s) << jump;
    EXPECT_TRUE(IdleWithin(daemon, 2s)) << jump;
  }
  const auto later =
      std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now()) + std::chrono::days(3650);
  const std::string year = std::to_string(int(std::chrono::year_month_day(later).year()));
  EXPECT_THAT(daemon.process().Err(), ::testing::HasSubstr(year + "-")) << "the clock did not jump";
  daemon.process().Signal(SIGTERM);
  EXPECT_EQ(daemon.process().Wait(), 0);
}

}  // namespace
}  // namespace patchmill
