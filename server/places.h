// Places for calls: how many run at once, and who comes next. No call starts while the server drains.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <list>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include <absl/status/statusor.h>

namespace patchmill {

// One pool of places with a queue. A free place goes to the caller that has the fewest places; among equal
// callers to the call that has waited longest.
class Places {
 public:
  // At most `places` calls run at once, and at most `queue` calls wait.
  Places(int places, int queue) : places_(places), queue_(queue) {}
  Places(const Places&) = delete;
  Places& operator=(const Places&) = delete;

  // One of the places. It is free again when the ticket is destroyed.
  class Ticket {
   public:
    Ticket(Places* from, std::string caller) : from_(from), caller_(std::move(caller)) {}
    Ticket(Ticket&& other) noexcept : from_(other.from_), caller_(std::move(other.caller_)) {
      other.from_ = nullptr;
    }
    Ticket& operator=(Ticket&&) = delete;
    ~Ticket() {
      if (from_ != nullptr) from_->Leave(caller_);
    }

   private:
    Places* from_;
    std::string caller_;
  };

  // A call that waits for a place.
  struct Waiting {
    std::string caller;                       // empty: nobody in particular
    int most = 0;                             // calls of this caller that run at once; 0: any number
    std::function<bool()> gone;               // true: the call need not wait any longer
    std::function<void(int place)> on_place;  // may be empty; called every now and then, from 1
    std::chrono::milliseconds poll{50};       // `gone` and `on_place` are called this often
  };
  // Waits for a place. RESOURCE_EXHAUSTED: TOO_MANY_JOBS if the queue is full, QUOTA_EXCEEDED if
  // kWaitingForEach calls wait for each place that this caller may have. UNAVAILABLE DRAINING while the
  // server drains, CANCELLED if the call is gone.
  absl::StatusOr<Ticket> Enter(const Waiting& call);

  // OK, or UNAVAILABLE DRAINING.
  absl::Status CheckOpen() const;
  // Refuses further calls, those that wait among them.
  void Drain();
  int running() const;
  int waiting() const;
  int places() const { return places_; }

 private:
  struct Waiter {
    std::string caller;
    int most = 0;
    bool chosen = false;
  };

  static constexpr int kWaitingForEach = 4;
  void Leave(const std::string& caller);
  void Choose();  // gives free places to waiters
  int PlaceOf(const Waiter& waiter) const;

  const int places_, queue_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::list<Waiter> waiters_;        // longest waiting first; chosen ones leave
  std::map<std::string, int> runs_;  // running calls by caller
  int running_ = 0;
  bool draining_ = false;
};

}  // namespace patchmill
