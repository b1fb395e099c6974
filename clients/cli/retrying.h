// When a command makes its call again.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include <grpcpp/support/status.h>

#include "clients/cli/connection.h"

namespace patchmill::cli {

// The tries of one call. Every call of the contract may be made again: a job has no side effects, and
// an upload or a removal does the same twice. A call that breaks is made three times at most: it may
// be the reason why its server ended. A server that drains, or is gone after a loss, is asked again
// for a minute. A server that does not answer the first try is not asked again: its address may be
// wrong.
class Tries {
 public:
  explicit Tries(const CommonOptions& options);

  // The options of the next try: with the time that --timeout leaves, and the one name of all tries.
  CommonOptions Left() const;

  // The time to wait before the next try, after one that ended so. Nothing if there is to be none.
  std::optional<std::chrono::milliseconds> WaitAfter(const grpc::Status& status);

  // The error to report after the last try: that of the try that broke, if nobody was reached since.
  grpc::Status Reported(const grpc::Status& last) const;

 private:
  using Clock = std::chrono::steady_clock;

  const CommonOptions& options_;
  const std::string request_id_;
  const Clock::time_point begin_ = Clock::now();
  std::optional<Clock::time_point> first_loss_;
  std::optional<grpc::Status> broken_;  // the last one
  int broken_count_ = 0, waits_ = 0;
};

}  // namespace patchmill::cli
