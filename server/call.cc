#include "server/call.h"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <new>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "core/base/polled_run.h"
#include "core/base/status.h"
#include "server/errors.h"
#include "server/job_progress.h"
#include "server/limits.h"
#include "server/lower_priority.h"
#include "server/process_memory.h"

namespace patchmill {
namespace {

using Clock = RunContext::Clock;

// The result. The worker thread writes it, the thread of the call reads it.
struct Board {
  std::mutex mutex;
  std::condition_variable changed;
  bool done = false;
  absl::Status status;
};

absl::Status Guarded(const std::function<absl::Status(const RunContext&)>& body, const RunContext& run) {
  const PolledRun counted(run);  // counts the memory of what is computed between parallel loops
  try {
    return body(run);
  } catch (const std::bad_alloc&) {
    return absl::ResourceExhaustedError("the job needs more memory than there is");
  } catch (const std::exception& e) {
    return absl::InternalError(fmt::format("unexpected: {}", e.what()));
  }
}

int Threads(int server, int request) {
  const int most = server > 0 ? server : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  return std::min({request > 0 ? request : most, most, limits::kMaxThreads});
}

Clock::time_point Deadline(const Call& call) {
  const Clock::time_point own =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(
                         std::chrono::duration<double>(call.env->options.max_job_seconds));
  return call.deadline ? std::min(own, *call.deadline) : own;
}

// The thread that works. An exception in the one that talks cancels it, and waits for its end.
class WorkerGuard {
 public:
  template <class Body>
  WorkerGuard(RunContext& run, Body body) : run_(run), thread_(std::move(body)) {}
  WorkerGuard(const WorkerGuard&) = delete;
  WorkerGuard& operator=(const WorkerGuard&) = delete;
  ~WorkerGuard() {
    if (!thread_.joinable()) return;
    run_.Cancel();
    thread_.join();
  }
  void Join() { thread_.join(); }

 private:
  RunContext& run_;
  std::thread thread_;
};

bool Ended(const Call& call) { return call.cancelled() || call.env->stopped.load(); }

absl::StatusOr<Places::Ticket> Enter(Places& places, const Call& call, const Work& work,
                                     JobProgress& progress) {
  bool listens = true;
  Clock::time_point next_beat = Clock::now();
  Places::Waiting waiting;
  waiting.caller = call.caller;
  if (&places == &call.env->jobs) waiting.most = call.env->callers.QuotasOf(call.caller).places.value_or(0);
  waiting.poll = std::chrono::milliseconds(limits::kCancelPollMs);
  const auto is_late = [&] { return call.deadline && Clock::now() >= *call.deadline; };
  waiting.gone = [&] { return !listens || Ended(call) || is_late(); };
  waiting.on_place = [&](int place) {
    progress.Queue(place);
    if (!work.beat || Clock::now() < next_beat) return;
    next_beat = Clock::now() + std::chrono::milliseconds(limits::kHeartbeatMs);
    listens = work.beat(progress.Now());
  };
  absl::StatusOr<Places::Ticket> place = places.Enter(waiting);
  if (absl::IsCancelled(place.status())) {
    if (call.env->stopped.load()) return DrainingError();
    if (is_late()) return absl::DeadlineExceededError("the deadline passed in the queue");
  }
  return place;
}

// The memory of one call, and its share of the ledger.
class Memory {
 public:
  // `process_limit`: bytes that the whole process may have.
  Memory(MemoryLedger& ledger, std::int64_t process_limit)
      : ledger_(ledger),
        process_limit_(process_limit),
        budget_(0, [this](std::int64_t bytes) { return Take(bytes); }) {}
  ~Memory() { ledger_.Release(taken_); }
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;

  absl::Status Start(std::int64_t estimate) {
    if (estimate > ledger_.limit()) {
      return LimitError("estimated_job_memory_bytes", static_cast<double>(ledger_.limit()),
                        static_cast<double>(estimate));
    }
    if (budget_.Fits(estimate)) return absl::OkStatus();
    if (ledger_.taken() == 0) return Exceeded();  // nobody else has any: it will never be there
    return TooMuchMemoryError(static_cast<double>(ledger_.limit()), static_cast<double>(ledger_.taken()),
                              static_cast<double>(estimate));
  }
  MemoryBudget& budget() { return budget_; }
  // RESOURCE_EXHAUSTED: what the job wanted when there was no more.
  absl::Status Exceeded() const {
    return JobMemoryError(static_cast<double>(budget_.granted()), static_cast<double>(needed_));
  }

 private:
  bool Take(std::int64_t bytes) {
    if (ledger_.Take(bytes)) {
      if (ProcessHasRoom(bytes, process_limit_)) {
        taken_ += bytes;
        return true;
      }
      ledger_.Release(bytes);
    }
    needed_ = std::max(needed_, budget_.granted() + bytes);
    return false;
  }

  MemoryLedger& ledger_;
  const std::int64_t process_limit_;
  std::int64_t taken_ = 0, needed_ = 0;  // the budget asks one call at a time
  MemoryBudget budget_;
};

// Counts the seconds of a job for its caller.
class JobSeconds {
 public:
  explicit JobSeconds(const Call& call) : call_(call) {}
  // Counts those since the last time. RESOURCE_EXHAUSTED QUOTA_EXCEEDED.
  absl::Status Count() {
    const Clock::time_point now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - std::exchange(counted_, now)).count();
    return call_.env->callers.TakeJobSeconds(call_.caller, seconds);
  }

 private:
  const Call& call_;
  Clock::time_point counted_ = Clock::now();
};

enum class Priority { kNormal, kLow };

absl::Status RunInThread(const Call& call, const Work& work, JobProgress& progress, Priority priority,
                         const std::function<absl::Status(const RunContext&)>& body) {
  Memory memory(call.env->memory, call.env->shares.limit);
  PM_RETURN_IF_ERROR(memory.Start(work.memory_bytes));
  JobSeconds seconds(call);
  absl::Status quota;
  Board board;
  RunContext run(Threads(call.env->options.threads, work.max_threads));
  run.set_deadline(Deadline(call));
  run.set_budget(&memory.budget());
  run.set_progress([&progress](std::string_view step, double fraction) { progress.Step(step, fraction); });
  WorkerGuard worker(run, [&] {
    if (call.env->options.lower_priority_of_jobs && priority == Priority::kLow) LowerPriorityOfThread();
    absl::Status status = Guarded(body, run);
    const std::lock_guard<std::mutex> lock(board.mutex);
    board.status = std::move(status);
    board.done = true;
    board.changed.notify_all();
  });

  Clock::time_point next_beat = Clock::now() + std::chrono::milliseconds(limits::kHeartbeatMs);
  std::unique_lock<std::mutex> lock(board.mutex);
  while (!board.done) {
    board.changed.wait_for(lock, std::chrono::milliseconds(limits::kCancelPollMs));
    if (board.done) break;
    if (priority == Priority::kLow && quota.ok()) quota = seconds.Count();
    if (Ended(call) || !quota.ok()) run.Cancel();
    if (!work.beat || run.Cancelled() || Clock::now() < next_beat) continue;
    next_beat = Clock::now() + std::chrono::milliseconds(limits::kHeartbeatMs);
    lock.unlock();  // a slow reader must not delay the work
    if (!work.beat(progress.Now())) run.Cancel();
    lock.lock();
  }
  lock.unlock();
  worker.Join();
  if (!quota.ok()) return quota;
  if (priority == Priority::kLow) (void)seconds.Count();
  if (memory.budget().Exceeded()) return memory.Exceeded();
  if (call.env->stopped.load() && !board.status.ok()) return DrainingError();
  // A cancel counts even if the work finished at the same time.
  if (call.cancelled()) run.Cancel();
  const absl::Status late = run.Check();
  return late.ok() ? board.status : late;
}

}  // namespace

ServerEnv::ServerEnv(const ServerOptions& given, ReceivedBytes received, std::unique_ptr<DiskCache> disk)
    : options(given),
      shares(ShareMemory(
          given.memory_limit_mib > 0 ? std::int64_t{given.memory_limit_mib} << 20 : DefaultMemoryLimit(),
          std::int64_t{given.max_in_flight_mib} << 20, std::int64_t{given.store_mib} << 20)),
      quick(limits::kQuickPlaces, limits::kMaxQueue),
      jobs(given.max_jobs > 0 ? given.max_jobs
                              : static_cast<int>(std::max(1u, std::thread::hardware_concurrency())),
           given.max_queue),
      in_flight(static_cast<std::size_t>(shares.in_flight), std::move(received)),
      memory(shares.jobs),
      store(static_cast<std::size_t>(shares.store),
            [this](const std::string& caller) { return callers.QuotasOf(caller).store_bytes; }),
      answers(store, std::move(disk)),
      running([this](const StoreKey& key, const std::string& from,
                     Messages messages) { answers.Put(key, from, std::move(messages)); },
              memory, given.orphan_seconds) {}

ModelAccess ModelsOf(const Call& call) { return {&call.env->in_flight, &call.env->store, call.caller}; }

absl::Status RunQuickCall(const Call& call, const Work& work,
                          const std::function<absl::Status(const RunContext&)>& body) {
  JobProgress progress;
  PM_ASSIGN_OR_RETURN(const Places::Ticket place, Enter(call.env->quick, call, work, progress));
  return RunInThread(call, work, progress, Priority::kNormal, body);
}

absl::Status RunJobCall(const Call& call, const Work& work,
                        const std::function<absl::Status(const RunContext&)>& body) {
  JobProgress progress;
  PM_RETURN_IF_ERROR(call.env->callers.TakeJobSeconds(call.caller, 0.0));
  PM_ASSIGN_OR_RETURN(const Places::Ticket place, Enter(call.env->jobs, call, work, progress));
  progress.Queue(0);
  return RunInThread(call, work, progress, Priority::kLow, body);
}

absl::Status CheckThreads(int max_threads, std::string_view field) {
  if (max_threads >= 0 && max_threads <= limits::kMaxThreads) return absl::OkStatus();
  FieldErrors errors;
  errors.Add(std::string(field), fmt::format("= {}; must be in [0, {}]", max_threads, limits::kMaxThreads));
  return errors.ToStatus();
}

absl::Status CheckRequestId(const std::string& id) {
  const bool printable = std::all_of(id.begin(), id.end(), [](char c) { return c >= ' ' && c <= '~'; });
  if (id.size() <= limits::kMaxRequestIdBytes && printable) return absl::OkStatus();
  FieldErrors errors;
  errors.Add("request_id",
             fmt::format("must be at most {} printable ASCII characters", limits::kMaxRequestIdBytes));
  return errors.ToStatus();
}

const char* ServerVersion() { return PATCHMILL_VERSION; }

}  // namespace patchmill
