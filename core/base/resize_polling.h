// Resizing of large vectors that can be cancelled: the first touch of new memory is slow.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <absl/status/status.h>

#include "core/base/run_context.h"
#include "core/base/status.h"

namespace patchmill {

// Does v.resize(size), with size >= v.size(). Returns CANCELLED or DEADLINE_EXCEEDED within some thousand
// elements.
template <typename T>
absl::Status ResizePolling(std::vector<T>& v, std::size_t size, const RunContext& run) {
  constexpr std::size_t kBetweenPolls = 1 << 14;
  v.reserve(size);
  while (v.size() < size) {
    PM_RETURN_IF_ERROR(run.Check());
    v.resize(std::min(size, v.size() + kBetweenPolls));
  }
  return absl::OkStatus();
}

}  // namespace patchmill
