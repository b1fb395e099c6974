#include "server/running_jobs.h"

#include <exception>
#include <new>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "server/errors.h"
#include "server/limits.h"

namespace patchmill {

RunningJobs::~RunningJobs() {
  StopAll(DrainingError());
  for (Entry& entry : entries_) entry.thread.join();
}

bool RunningJobs::Gone(const Answer& answer) const {
  if (answer.stopped()) return true;
  const auto since = answer.alone_since();
  return since && std::chrono::steady_clock::now() - *since >= std::chrono::duration<double>(orphan_seconds_);
}

void RunningJobs::Run(const Job& job, const std::shared_ptr<Answer>& answer) {
  absl::Status status;
  try {
    status = job.work(*answer, [this, &answer] { return Gone(*answer); });
  } catch (const std::bad_alloc&) {
    status = absl::ResourceExhaustedError("the job needs more memory than there is");
  } catch (const std::exception& e) {
    status = absl::InternalError(fmt::format("unexpected: {}", e.what()));
  }
  answer->End(std::move(status));
  if (auto whole = answer->whole()) keep_(job.key, job.from, *std::move(whole));
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto at = by_key_.find(job.key);
  if (at != by_key_.end() && at->second.lock() == answer) by_key_.erase(at);
}

void RunningJobs::JoinEnded() {
  for (auto entry = entries_.begin(); entry != entries_.end();) {
    if (!entry->ended.load()) {
      ++entry;
      continue;
    }
    entry->thread.join();
    entry = entries_.erase(entry);
  }
}

absl::StatusOr<RunningJobs::Reading> RunningJobs::Start(Job job) {
  const std::lock_guard<std::mutex> lock(mutex_);
  JoinEnded();
  if (const auto at = by_key_.find(job.key); at != by_key_.end()) {
    if (auto answer = at->second.lock()) {
      if (auto reader = answer->Read()) return Reading{std::move(answer), std::move(reader), true};
    }
  }
  Reading reading;
  reading.answer = std::make_shared<Answer>(limits::kMaxKeptAnswerBytes, ledger_);
  reading.reader = reading.answer->Read();
  Entry& entry = entries_.emplace_back();
  entry.answer = reading.answer;
  by_key_[job.key] = reading.answer;
  try {
    entry.thread = std::thread([this, &entry, answer = reading.answer, job = std::move(job)] {
      Run(job, answer);
      {
        const std::lock_guard<std::mutex> ended(mutex_);
        entry.answer.reset();  // its memory need not wait until the thread is joined
      }
      entry.ended.store(true);
    });
  } catch (const std::system_error&) {
    entries_.pop_back();
    return absl::ResourceExhaustedError("the server has no thread for the job; try again later");
  }
  return reading;
}

void RunningJobs::StopAll(const absl::Status& reason) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (Entry& entry : entries_) {
    if (entry.answer) entry.answer->Stop(reason);
  }
}

int RunningJobs::running() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  int count = 0;
  for (const Entry& entry : entries_) count += !entry.ended.load();
  return count;
}

}  // namespace patchmill
