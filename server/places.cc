#include "server/places.h"

#include <algorithm>

#include "server/errors.h"
#include "server/operate/caller_errors.h"

namespace patchmill {

absl::Status Places::CheckOpen() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return draining_ ? DrainingError() : absl::OkStatus();
}

int Places::running() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return running_;
}

int Places::waiting() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return static_cast<int>(waiters_.size());
}

void Places::Drain() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    draining_ = true;
  }
  changed_.notify_all();
}

void Places::Leave(const std::string& caller) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    --running_;
    const auto at = runs_.find(caller);
    if (--at->second == 0) runs_.erase(at);
    Choose();
  }
  changed_.notify_all();
}

void Places::Choose() {
  while (running_ < places_) {
    Waiter* next = nullptr;
    int fewest = 0;
    for (Waiter& waiter : waiters_) {
      if (waiter.chosen) continue;
      const auto at = runs_.find(waiter.caller);
      const int runs = at == runs_.end() ? 0 : at->second;
      if (waiter.most > 0 && runs >= waiter.most) continue;
      if (next == nullptr || runs < fewest) {
        next = &waiter;
        fewest = runs;
      }
    }
    if (next == nullptr) return;
    next->chosen = true;
    ++running_;
    ++runs_[next->caller];
  }
}

// Which caller will be free next is not known: the place counts the calls that have waited longer.
int Places::PlaceOf(const Waiter& waiter) const {
  int place = 1;
  for (const Waiter& other : waiters_) {
    if (&other == &waiter) break;
    place += !other.chosen;
  }
  return place;
}

absl::StatusOr<Places::Ticket> Places::Enter(const Waiting& call) {
  std::unique_lock<std::mutex> lock(mutex_);
  if (draining_) return DrainingError();
  const auto self = waiters_.insert(waiters_.end(), Waiter{call.caller, call.most});
  Choose();
  if (!self->chosen) {
    int all = 0, own = 0;  // calls that wait, this one among them
    for (const Waiter& waiter : waiters_) {
      all += !waiter.chosen;
      own += !waiter.chosen && waiter.caller == call.caller;
    }
    const bool is_full = all > queue_;
    if (is_full || (call.most > 0 && own > kWaitingForEach * call.most)) {
      waiters_.erase(self);
      if (is_full) return TooManyJobsError(places_, queue_);
      const int quota = (1 + kWaitingForEach) * call.most;
      return QuotaError("caller_jobs", quota, quota + 1, std::chrono::seconds(2));
    }
  }
  absl::Status ended;
  while (!self->chosen) {
    if (draining_) {
      ended = DrainingError();
      break;
    }
    changed_.wait_for(lock, call.poll);
    if (self->chosen) break;
    const int place = PlaceOf(*self);
    lock.unlock();  // neither function may hold up others
    if (call.on_place) call.on_place(place);
    const bool gone = call.gone && call.gone();
    lock.lock();
    if (gone) {
      ended = absl::CancelledError("the call ended while it waited for a place");
      break;
    }
  }
  const bool chosen = self->chosen;
  waiters_.erase(self);
  lock.unlock();
  if (chosen) {
    Ticket ticket(this, call.caller);  // gives the place back if the call has ended meanwhile
    if (!ended.ok()) return ended;
    return ticket;
  }
  return ended;
}

}  // namespace patchmill
