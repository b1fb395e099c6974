#include "clients/cli/retrying.h"

#include <algorithm>
#include <random>

#include <fmt/format.h>

namespace patchmill::cli {
namespace {

using std::chrono::milliseconds;

constexpr int kMostBroken = 3;                            // tries that may break
constexpr std::chrono::seconds kLongest(60);              // from the first loss to the last try
constexpr milliseconds kFirstWait(250), kLastWait(2000);  // each wait is twice the one before

// Clients that lost the same server do not come back all at once.
milliseconds Spread(milliseconds wait) {
  std::random_device seed;
  std::uniform_real_distribution<double> share(0.75, 1.25);
  return milliseconds(static_cast<std::int64_t>(static_cast<double>(wait.count()) * share(seed)));
}

// A name that no other command has.
std::string RandomName() {
  std::random_device random;
  return fmt::format("{:08x}{:08x}", random(), random());
}

}  // namespace

Tries::Tries(const CommonOptions& options) : options_(options), request_id_(RandomName()) {}

CommonOptions Tries::Left() const {
  CommonOptions left = options_;
  left.request_id = request_id_;
  const std::chrono::duration<double> passed = Clock::now() - begin_;
  if (left.timeout) left.timeout = std::max(0.0, *left.timeout - passed.count());
  return left;
}

std::optional<milliseconds> Tries::WaitAfter(const grpc::Status& status) {
  const Loss loss = LossOf(status);
  if (loss == Loss::kNone || options_.server.empty()) return std::nullopt;
  if (loss == Loss::kUnreachable && !first_loss_) return std::nullopt;
  if (loss == Loss::kBroken) {
    broken_ = status;
    if (++broken_count_ == kMostBroken) return std::nullopt;
  }
  if (!first_loss_) first_loss_ = Clock::now();
  const milliseconds wait = Spread(std::min(kLastWait, kFirstWait * (1 << std::min(waits_, 3))));
  if (Clock::now() + wait > *first_loss_ + kLongest) return std::nullopt;
  const std::optional<double> left = Left().timeout;
  if (left && *left <= std::chrono::duration<double>(wait).count()) return std::nullopt;
  ++waits_;
  return wait;
}

grpc::Status Tries::Reported(const grpc::Status& last) const {
  // The server knows the deadline, too, and its clock may be ahead: then it ends the call first, by
  // CANCELLED.
  constexpr double kWay = 0.1;  // s
  const std::optional<double> left = Left().timeout;
  if (last.error_code() == grpc::StatusCode::CANCELLED && left && *left <= kWay)
    return {grpc::StatusCode::DEADLINE_EXCEEDED, last.error_message()};
  return broken_ && LossOf(last) == Loss::kUnreachable ? *broken_ : last;
}

}  // namespace patchmill::cli
