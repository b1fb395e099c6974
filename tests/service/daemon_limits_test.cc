// Requests that once ended the server or blocked it. It answers them with a reason and continues to serve.
#include <chrono>
#include <future>
#include <memory>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "patchmill/v1/analysis_service.pb.h"
#include "patchmill/v1/model_service.grpc.pb.h"
#include "server/listen_address.h"
#include "tests/service/daemon.h"
#include "tests/service/raw_stub.h"
#include "tests/service/requests.h"
#include "tests/service/status_matchers.h"
#include "tests/support/sanitized.h"

namespace patchmill {
namespace {

using namespace std::chrono_literals;
using grpc::StatusCode;
using ::testing::AllOf;
using testing::BombOfOperations;
using testing::CallWithBytes;
using testing::Daemon;
using testing::Finished;
using ::testing::HasSubstr;
using testing::InfoOf;
using testing::kCheckModel;
using testing::kEvaluateSurface;
using testing::kGenerateProgram;
using testing::kHealthCheck;
using testing::kReflection;
using testing::LengthDelimited;
using testing::RawStream;

const std::string kPatchmill = PATCHMILL_BIN "/patchmill";
const std::string kDaemon = PATCHMILL_BIN "/patchmilld";

// A connection of its own for each.
std::shared_ptr<grpc::Channel> ChannelTo(const Daemon& daemon) {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 100);
  arguments.SetMaxSendMessageSize(-1);
  arguments.SetInt(GRPC_ARG_HTTP2_BDP_PROBE, 0);  // no more than 64 KiB come that nobody reads
  return grpc::CreateCustomChannel(daemon.target(), grpc::InsecureChannelCredentials(), arguments);
}

bool Healthy(const Daemon& daemon) {
  return testing::Run({kDaemon, "--check-health", daemon.target()}).status == 0;
}

int StopStatus(Daemon& daemon) {
  daemon.process().Signal(SIGTERM);
  return daemon.process().Wait();
}

// Each would take 700 MiB when parsed, and they come at once.
TEST(DaemonLimits, BombsOfEmptyMessagesCostLittleMoreThanTheirBytes) {
  Daemon daemon(kDaemon);
  const std::string bomb = BombOfOperations(7'500'000);
  std::vector<std::future<grpc::Status>> calls;
  for (int k = 0; k < 4; ++k) {
    calls.push_back(std::async(std::launch::async,
                               [&] { return CallWithBytes(ChannelTo(daemon), kGenerateProgram, bomb); }));
  }
  for (auto& call : calls) {
    const grpc::Status status = call.get();
    EXPECT_EQ(status.error_code(), StatusCode::RESOURCE_EXHAUSTED) << status.error_message();
    EXPECT_EQ(InfoOf(status).limit(), "job.operations");
  }
  EXPECT_LT(daemon.PeakMib(), testing::kSanitized ? 1000.0 : 300.0);
  EXPECT_TRUE(Healthy(daemon));
  EXPECT_EQ(StopStatus(daemon), 0);
}

// 24 requests of 32 MiB at a server that holds 64 MiB of them: they are counted while they come.
TEST(DaemonLimits, RequestsOnTheirWayAreCounted) {
  Daemon daemon(kDaemon, {"--max-in-flight-mib", "64"});
  v1::CheckModelRequest request;
  request.mutable_source()->mutable_file()->set_format("json");
  request.mutable_source()->mutable_file()->set_content(std::string(std::size_t{31} << 20, ' '));
  const std::string bytes = request.SerializeAsString();
  std::vector<std::future<grpc::Status>> calls;
  for (int k = 0; k < 24; ++k) {
    calls.push_back(
        std::async(std::launch::async, [&] { return CallWithBytes(ChannelTo(daemon), kCheckModel, bytes); }));
  }
  int refused = 0;
  for (auto& call : calls) {
    const grpc::Status status = call.get();
    const std::string reason = InfoOf(status).reason();
    EXPECT_TRUE(reason == "TOO_MANY_BYTES" || reason == "TOO_MANY_JOBS" || reason == "MODEL_UNREADABLE")
        << status.error_code() << " " << status.error_message();
    refused += reason == "TOO_MANY_BYTES";
  }
  EXPECT_GT(refused, 0);
  EXPECT_LT(daemon.PeakMib(), testing::kSanitized ? 1000.0 : 350.0);
  const grpc::Status one = CallWithBytes(ChannelTo(daemon), kCheckModel, bytes);
  EXPECT_EQ(InfoOf(one).reason(), "MODEL_UNREADABLE") << one.error_message();  // nothing is held any more
}

// Methods that gRPC would serve itself are counted as all others are.
TEST(DaemonLimits, RequestsOfHealthAndReflectionAreCounted) {
  Daemon daemon(kDaemon, {"--max-in-flight-mib", "32"});
  const std::string bytes = LengthDelimited(1, std::string(std::size_t{40} << 20, ' '));
  std::vector<std::future<grpc::Status>> calls;
  for (int k = 0; k < 12; ++k) {
    const char* method = k % 2 == 0 ? kHealthCheck : kReflection;
    calls.push_back(std::async(std::launch::async,
                               [&, method] { return CallWithBytes(ChannelTo(daemon), method, bytes); }));
  }
  for (auto& call : calls) {
    const grpc::Status status = call.get();
    EXPECT_EQ(status.error_code(), StatusCode::RESOURCE_EXHAUSTED) << status.error_message();
    EXPECT_NE(InfoOf(status).reason(), "") << status.error_message();
  }
  EXPECT_LT(daemon.PeakMib(), testing::kSanitized ? 800.0 : 250.0);
  EXPECT_TRUE(Healthy(daemon));
}

// An answer of 3 MiB.
std::string ManyPoints() {
  v1::EvaluateSurfaceRequest request;
  *request.mutable_source()->mutable_model() = testing::Bump();
  for (int k = 0; k < 14'000; ++k) {
    request.add_patch_index(0);
    for (const int step : {7, 11}) request.add_uv((k * step % 1009 + 0.5) / 1009.0);
  }
  return request.SerializeAsString();
}

TEST(DaemonLimits, AnswersThatAreNotReadAreCounted) {
  Daemon daemon(kDaemon, {"--max-in-flight-mib", "8"});
  const std::string bytes = ManyPoints();
  EXPECT_TRUE(CallWithBytes(ChannelTo(daemon), kEvaluateSurface, bytes).ok());
  {
    const auto channel = ChannelTo(daemon);
    RawStream one(channel, kEvaluateSurface), two(channel, kEvaluateSurface);
    for (RawStream* stream : {&one, &two}) {
      ASSERT_TRUE(stream->Write(bytes));
      ASSERT_TRUE(stream->Answered());
    }
    const grpc::Status refused = CallWithBytes(ChannelTo(daemon), kEvaluateSurface, bytes);
    EXPECT_EQ(InfoOf(refused).reason(), "TOO_MANY_BYTES") << refused.error_message();
    EXPECT_EQ(InfoOf(refused).limit(), "response_bytes_in_flight");
  }
  bool answers = false;  // once the others are gone
  for (int k = 0; k < 200 && !answers; ++k) {
    answers = CallWithBytes(ChannelTo(daemon), kEvaluateSurface, bytes).ok();
    if (!answers) std::this_thread::sleep_for(50ms);
  }
  EXPECT_TRUE(answers);
}

TEST(DaemonLimits, AClientThatDoesNotReadIsCutOff) {
  Daemon daemon(kDaemon, {"--max-write-seconds", "0.3"});
  RawStream stream(ChannelTo(daemon), kEvaluateSurface);
  ASSERT_TRUE(stream.Write(ManyPoints()));
  const std::string why = "the client has not taken an answer within 0.3 s";
  for (int k = 0; k < 400 && daemon.process().Err().find(why) == std::string::npos; ++k)
    std::this_thread::sleep_for(50ms);
  EXPECT_THAT(daemon.process().Err(), HasSubstr(why));
  EXPECT_EQ(stream.Read(), std::nullopt);
  EXPECT_EQ(stream.Finish().error_code(), StatusCode::CANCELLED);
}

// The preface of HTTP/2 and empty settings: a connection that is open, and asks for nothing.
TEST(DaemonLimits, AConnectionWithoutCallsIsClosed) {
  Daemon daemon(kDaemon, {"--max-idle-seconds", "1"});
  const SocketAddress address = ResolveListenAddress(daemon.target())->front();
  const int idle = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  ASSERT_EQ(connect(idle, address.get(), address.size), 0);
  const timeval most{.tv_sec = 20, .tv_usec = 0};
  setsockopt(idle, SOL_SOCKET, SO_RCVTIMEO, &most, sizeof most);
  const std::string_view hello("PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n\0\0\0\4\0\0\0\0\0", 33);
  ASSERT_EQ(send(idle, hello.data(), hello.size(), 0), static_cast<ssize_t>(hello.size()));
  ssize_t got = 1;
  for (char bytes[1024]; got > 0;) got = recv(idle, bytes, sizeof bytes, 0);
  EXPECT_TRUE(got == 0 || errno == ECONNRESET) << errno;
  close(idle);
  EXPECT_TRUE(Healthy(daemon));
}

// A B-spline of degree 15 with equal spans over a plate.
v1::CheckModelRequest Plate(int spans) {
  constexpr int kDegree = 15;
  v1::CheckModelRequest request;
  v1::PatchModel& model = *request.mutable_source()->mutable_model();
  model.set_length_unit(v1::LENGTH_UNIT_MILLIMETER);
  v1::BsplinePatch& bspline = *model.add_patches()->mutable_bspline();
  bspline.set_degree_u(kDegree);
  bspline.set_degree_v(kDegree);
  for (int k = -kDegree; k <= spans + kDegree; ++k) bspline.add_knots_u(std::clamp(k, 0, spans));
  *bspline.mutable_knots_v() = bspline.knots_u();
  const int points = spans + kDegree;
  for (int i = 0; i < points * points; ++i) {
    for (const double x : {0.1 * (i / points), 0.1 * (i % points), 0.001 * (i * 31 % 7)})
      bspline.add_points(x);
  }
  return request;
}

grpc::Status CheckWithin(const Daemon& daemon, const v1::CheckModelRequest& request,
                         std::chrono::milliseconds most) {
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + most);
  v1::CheckModelResponse response;
  return v1::ModelService::NewStub(ChannelTo(daemon))->CheckModel(&context, request, &response);
}

// Whether the process becomes idle within that time, that is, for a tenth of a second.
bool IdleWithin(const Daemon& daemon, std::chrono::milliseconds most) {
  const auto until = std::chrono::steady_clock::now() + most;
  double before = daemon.CpuSeconds();
  while (std::chrono::steady_clock::now() < until) {
    std::this_thread::sleep_for(100ms);
    const double now = daemon.CpuSeconds();
    if (now - before <= 0.01) return true;
    before = now;
  }
  return false;
}

// 62,500 points make 55,225 pieces of 256.
TEST(DaemonLimits, ABsplineIsRefusedForWhatIsMadeOfIt) {
  Daemon daemon(kDaemon);
  const grpc::Status status = CheckWithin(daemon, Plate(235), 20s);
  EXPECT_EQ(status.error_code(), StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_THAT(status.error_message(),
              AllOf(HasSubstr("model.control_point_count = 14137600; the limit is 2500000"),
                    HasSubstr("patches[0].bspline")));
  EXPECT_TRUE(IdleWithin(daemon, 500ms));
  EXPECT_LT(daemon.PeakMib(), testing::kSanitized ? 600.0 : 100.0);
}

// The largest that is taken is seconds of work: at every moment of it a deadline ends it.
TEST(DaemonLimits, ALargeBsplineObeysDeadlinesAndSigterm) {
  Daemon daemon(kDaemon);
  const v1::CheckModelRequest plate = Plate(98);
  const int slower = testing::kSanitized ? 10 : 1;
  for (const auto deadline : {300ms, 700ms, 1500ms}) {
    const grpc::Status status = CheckWithin(daemon, plate, deadline);
    if (!status.ok()) {
      EXPECT_EQ(status.error_code(), StatusCode::DEADLINE_EXCEEDED) << status.error_message();
    }
    EXPECT_TRUE(IdleWithin(daemon, slower * 500ms)) << deadline.count();
  }
  // It ends while it drains, or is cut off and heeds that.
  std::future<grpc::Status> running =
      std::async(std::launch::async, [&] { return CheckWithin(daemon, plate, 60s); });
  std::this_thread::sleep_for(500ms);
  EXPECT_EQ(StopStatus(daemon), 0);
  running.get();
}

// More connections than descriptors, of clients that say nothing; then they are gone.
TEST(DaemonLimits, ServesAgainAfterItsDescriptorsRanOut) {
  Daemon daemon(kDaemon, {}, "ulimit -n 200");
  ASSERT_TRUE(Healthy(daemon));
  const SocketAddress address = ResolveListenAddress(daemon.target())->front();
  std::vector<int> sockets;
  for (int k = 0; k < 260; ++k) {
    const int socket_of_client = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    ASSERT_GE(socket_of_client, 0);
    EXPECT_EQ(connect(socket_of_client, address.get(), address.size), 0) << k;
    sockets.push_back(socket_of_client);
  }
  std::this_thread::sleep_for(300ms);
  EXPECT_FALSE(Healthy(daemon));
  for (const int socket_of_client : sockets) close(socket_of_client);
  bool serves = false;
  for (int k = 0; k < 20 && !serves; ++k) {
    std::this_thread::sleep_for(100ms);
    serves = Healthy(daemon);
  }
  EXPECT_TRUE(serves) << daemon.process().Err();
  EXPECT_THAT(daemon.process().Err(), HasSubstr("connections are open, as many as there may be"));
  EXPECT_EQ(StopStatus(daemon), 0);
}

TEST(DaemonLimits, ListensBeyondLoopbackWithTlsOrWhenToldThatItIsInsecure) {
  for (const std::vector<std::string>& server : {std::vector<std::string>{kDaemon}, {kPatchmill, "serve"}}) {
    for (const char* place : {"0.0.0.0:0", "[::]:0"}) {
      std::vector<std::string> command = server;
      command.insert(command.end(), {"--listen", place});
      const Finished refused = testing::Run(command);
      EXPECT_EQ(refused.status, 2) << place;
      EXPECT_THAT(refused.err,
                  AllOf(HasSubstr(place), HasSubstr("--cert and --key"), HasSubstr("--insecure")));
    }
  }
  Daemon open(kDaemon, {"--listen", "0.0.0.0:0", "--insecure"});
  EXPECT_TRUE(Healthy(open));
  EXPECT_EQ(StopStatus(open), 0);
}

}  // namespace
}  // namespace patchmill
