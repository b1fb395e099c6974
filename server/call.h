// One running call: who asked, how long it may take, whether it is still wanted; and how its work is run.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <absl/status/status.h>
#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "server/admission.h"
#include "server/in_flight.h"
#include "server/options.h"

namespace patchmill {

// What all calls of a server share.
struct ServerEnv {
  ServerOptions options;
  Admission admission;
  InFlight in_flight;
  explicit ServerEnv(ServerOptions o, ReceivedBytes received = {})
      : options(std::move(o)),
        admission(options.max_jobs),
        in_flight(static_cast<std::size_t>(options.max_in_flight_mib) << 20, std::move(received)) {}
};

// What a handler knows of its caller; filled from grpc::ServerContext, or by a test.
struct Call {
  ServerEnv* env = nullptr;
  std::function<bool()> cancelled = [] { return false; };
  std::optional<RunContext::Clock::time_point> deadline;  // nothing: only the server's own limit
};

// Where the messages of a stream go. False: the other side is gone, stop.
template <class Response>
using Sink = std::function<bool(const Response&)>;

// Stage and fraction; false: the other side is gone.
using Beat = std::function<bool(std::string_view stage, double fraction)>;

// Runs `work` in a thread of its own, with a RunContext that obeys the caller's cancel within
// limits::kCancelPollMs, its deadline and the server's limits on time and threads. Meanwhile this thread
// calls `beat` (may be empty) every limits::kHeartbeatMs, whether the work has progressed or not. An
// exception in `work` becomes a status: one bad request never disturbs another.
absl::Status RunJobThread(const Call& call, int max_threads, const Beat& beat,
                          const std::function<absl::Status(const RunContext&)>& work);

// INVALID_ARGUMENT when a thread count is out of [0, limits::kMaxThreads].
absl::Status CheckThreads(int max_threads, std::string_view field);

const char* ServerVersion();

}  // namespace patchmill
