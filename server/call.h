// One running call: its caller, its deadline and its cancel; and the thread that does its work.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <absl/status/status.h>
#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "patchmill/v1/report.pb.h"
#include "server/disk_cache.h"
#include "server/in_flight.h"
#include "server/kept_answers.h"
#include "server/memory_ledger.h"
#include "server/memory_limit.h"
#include "server/model_source.h"
#include "server/operate/callers.h"
#include "server/operate/metrics.h"
#include "server/options.h"
#include "server/places.h"
#include "server/running_jobs.h"
#include "server/store.h"

namespace patchmill {

// State that all calls of a server share.
struct ServerEnv {
  explicit ServerEnv(const ServerOptions& given, ReceivedBytes received = {},
                     std::unique_ptr<DiskCache> disk = nullptr);

  ServerOptions options;
  const MemoryShares shares;
  Callers callers;
  Metrics metrics;
  Places quick;  // for calls that take milliseconds
  Places jobs;   // for jobs
  InFlight in_flight;
  MemoryLedger memory;
  Store store;
  KeptAnswers answers;
  RunningJobs running;
  std::atomic<int> calls{0};         // that run, wait, or have not sent their answer yet
  std::atomic<bool> stopped{false};  // calls that still run are to end: the time to drain is over
};

// What a handler knows about its caller. It is filled from grpc::ServerContext, or by a test.
struct Call {
  ServerEnv* env = nullptr;
  std::string caller = {};  // empty where callers are not told apart
  std::function<bool()> cancelled = [] { return false; };
  std::optional<RunContext::Clock::time_point> deadline = {};  // absent: only the limit of the server holds
};

ModelAccess ModelsOf(const Call& call);

// Receives the messages of a stream. False: the other side is gone; stop.
template <class Response>
using Sink = std::function<bool(const Response&)>;

// Receives the progress. False: the other side is gone.
using Beat = std::function<bool(const v1::Progress&)>;

// What a call takes to do its work.
struct Work {
  int max_threads = 0;            // of the request
  std::int64_t memory_bytes = 0;  // estimate; the work may take more if there is more
  Beat beat = {};                 // called every limits::kHeartbeatMs, with or without progress; may be empty
};

// Waits for a place for a call of milliseconds, and runs `body` in its own thread. Its RunContext obeys a
// cancel of the caller within limits::kCancelPollMs, the deadline of the caller, and the server's limits on
// time, threads and memory. An exception in `body` becomes a status, so that one bad request never disturbs
// another. Errors, beside those of `body`: those of Places::Enter; RESOURCE_EXHAUSTED TOO_MUCH_MEMORY if the
// estimated memory is not there, LIMIT_EXCEEDED if it never will be, or if the work has taken more than it
// could be granted.
absl::Status RunQuickCall(const Call& call, const Work& work,
                          const std::function<absl::Status(const RunContext&)>& body);
// The same for a job. While it waits for its place, its progress has the place in the queue. QUOTA_EXCEEDED
// if the jobs of this caller have had their seconds of this day, also while this one runs.
absl::Status RunJobCall(const Call& call, const Work& work,
                        const std::function<absl::Status(const RunContext&)>& body);

// INVALID_ARGUMENT if a thread count is not in [0, limits::kMaxThreads].
absl::Status CheckThreads(int max_threads, std::string_view field);
// The same for request_id.
absl::Status CheckRequestId(const std::string& id);

const char* ServerVersion();

}  // namespace patchmill
