// One running call: its caller, its deadline and its cancel; and the thread that does its work.
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

// State that all calls of a server share.
struct ServerEnv {
  ServerOptions options;
  Admission admission;
  InFlight in_flight;
  explicit ServerEnv(ServerOptions o, ReceivedBytes received = {})
      : options(std::move(o)),
        admission(options.max_jobs),
        in_flight(static_cast<std::size_t>(options.max_in_flight_mib) << 20, std::move(received)) {}
};

// What a handler knows about its caller. It is filled from grpc::ServerContext, or by a test.
struct Call {
  ServerEnv* env = nullptr;
  std::function<bool()> cancelled = [] { return false; };
  std::optional<RunContext::Clock::time_point> deadline;  // absent: only the limit of the server holds
};

// Receives the messages of a stream. False: the other side is gone; stop.
template <class Response>
using Sink = std::function<bool(const Response&)>;

// Receives stage and fraction. False: the other side is gone.
using Beat = std::function<bool(std::string_view stage, double fraction)>;

// Runs `work` in its own thread. Its RunContext obeys a cancel of the caller within limits::kCancelPollMs,
// the deadline of the caller, and the server's limits on time and threads. Meanwhile this thread calls
// `beat` (may be empty) every limits::kHeartbeatMs, with or without progress. An exception in `work` becomes
// a status, so that one bad request never disturbs another.
absl::Status RunJobThread(const Call& call, int max_threads, const Beat& beat,
                          const std::function<absl::Status(const RunContext&)>& work);

// INVALID_ARGUMENT if a thread count is not in [0, limits::kMaxThreads].
absl::Status CheckThreads(int max_threads, std::string_view field);

const char* ServerVersion();

}  // namespace patchmill
