#include "core/base/run_context.h"

namespace patchmill {

absl::Status RunContext::Check() const {
  if (cancelled_.load(std::memory_order_relaxed)) return absl::CancelledError("cancelled by the caller");
  if (budget_ != nullptr && budget_->Exceeded())
    return absl::ResourceExhaustedError("the job needs more memory than it was granted");
  if (DeadlinePassed()) return absl::DeadlineExceededError("the deadline has passed");
  return absl::OkStatus();
}

}  // namespace patchmill
