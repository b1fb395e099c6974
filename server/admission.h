// Limits how many jobs run at once. No job starts while the server drains.
#pragma once

#include <atomic>

#include <absl/status/statusor.h>

#include "server/errors.h"

namespace patchmill {

class Admission {
 public:
  explicit Admission(int max_jobs) : max_jobs_(max_jobs) {}

  // One of the places. It is free again when the ticket is destroyed.
  class Ticket {
   public:
    explicit Ticket(Admission* from) : from_(from) {}
    Ticket(Ticket&& other) noexcept : from_(other.from_) { other.from_ = nullptr; }
    Ticket& operator=(Ticket&&) = delete;
    ~Ticket() {
      if (from_ != nullptr) from_->running_.fetch_sub(1);
    }

   private:
    Admission* from_;
  };

  // A place for a job. RESOURCE_EXHAUSTED TOO_MANY_JOBS if all are taken, UNAVAILABLE while draining.
  absl::StatusOr<Ticket> Enter() {
    if (draining_.load()) return DrainingError();
    if (running_.fetch_add(1) >= max_jobs_) {
      running_.fetch_sub(1);
      return TooManyJobsError(max_jobs_);
    }
    return Ticket(this);
  }

  void Drain() { draining_.store(true); }
  int running() const { return running_.load(); }

 private:
  const int max_jobs_;
  std::atomic<int> running_{0};
  std::atomic<bool> draining_{false};
};

}  // namespace patchmill
