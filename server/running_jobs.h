// The streaming jobs that run now, each in a thread of its own. A call whose request is that of a running job
// reads the answer of that job; a lost stream need not be lost work.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include <absl/status/status.h>
#include <absl/status/statusor.h>

#include "server/answer.h"
#include "server/memory_ledger.h"
#include "server/store.h"

namespace patchmill {

class RunningJobs {
 public:
  // `keep` gets answers that have ended well, with the key of their job and the digest of its model.
  using Keep = std::function<void(const StoreKey& key, const std::string& from, Messages messages)>;
  // A job without readers ends after `orphan_seconds`. `ledger` outlives it.
  RunningJobs(Keep keep, MemoryLedger& ledger, double orphan_seconds)
      : keep_(std::move(keep)), ledger_(ledger), orphan_seconds_(orphan_seconds) {}
  ~RunningJobs();  // stops all jobs and waits for them
  RunningJobs(const RunningJobs&) = delete;
  RunningJobs& operator=(const RunningJobs&) = delete;

  // What the caller of a job wants done: it writes the answer. `gone` is true when nobody wants it any more.
  struct Job {
    StoreKey key;      // of the answer in the store
    std::string from;  // digest of the model that the request names, if it names one
    std::function<absl::Status(Answer& answer, const std::function<bool()>& gone)> work;
  };
  // A place in the answer of a job, which lives as long as it is read.
  struct Reading {
    std::shared_ptr<Answer> answer;
    std::unique_ptr<Answer::Reader> reader;
    bool joined = false;  // the job ran before
  };
  // Joins the running job with this key, or starts it. An answer that has ended well is kept.
  // RESOURCE_EXHAUSTED where the system has no thread for it.
  absl::StatusOr<Reading> Start(Job job);

  // Stops all jobs. Their readers get `reason` as their end.
  void StopAll(const absl::Status& reason);
  int running() const;

 private:
  struct Entry {
    std::shared_ptr<Answer> answer;  // null when the job has ended
    std::thread thread;
    std::atomic<bool> ended{false};
  };

  void Run(const Job& job, const std::shared_ptr<Answer>& answer);
  bool Gone(const Answer& answer) const;
  void JoinEnded();

  const Keep keep_;
  MemoryLedger& ledger_;
  const double orphan_seconds_;
  mutable std::mutex mutex_;
  std::list<Entry> entries_;
  std::map<StoreKey, std::weak_ptr<Answer>> by_key_;
};

}  // namespace patchmill
