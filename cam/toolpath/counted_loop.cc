#include "cam/toolpath/counted_loop.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "core/base/parallel.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

// The number of calls between two checks of the sum. The first check comes after kFirst calls. After each
// check as many calls follow as there were before, because neighbouring lines and levels have about the same
// length. They are never more than would reach the limit if all were as long as the longest so far (but at
// least kFewest).
constexpr std::size_t kFirst = 64, kFewest = 16;

std::size_t CallsLeft(const PathLimits& limits, const PathAmount& made, const PathAmount& longest) {
  const auto calls = [](double limit, double so_far, double one) {
    return one > 0.0 ? std::max(0.0, (limit - so_far) / one) : kInfinity;
  };
  const double left = std::min(calls(limits.length, made.length, longest.length),
                               calls(limits.points, made.points, longest.points));
  return static_cast<std::size_t>(std::min(left, 1e9));
}

}  // namespace

absl::Status CountedFor(const RunContext& run, const char* stage, std::size_t count, const PathBudget& budget,
                        const std::function<PathAmount(std::size_t)>& body) {
  const PathLimits& limits = budget.limits;
  if (limits.length == kInfinity && limits.points == kInfinity)
    return ParallelFor(run, stage, count, [&](std::size_t i) { body(i); });
  PathAmount made = budget.made, longest;
  std::vector<PathAmount> amounts;
  for (std::size_t first = 0; first < count;) {
    const std::size_t most = first == 0 ? kFirst : std::min(first, CallsLeft(limits, made, longest));
    const LoopPart part{first, std::min(count, first + std::max(most, kFewest)), count};
    amounts.assign(part.last - first, {});
    PM_RETURN_IF_ERROR(
        ParallelFor(run, stage, part, [&](std::size_t i) { amounts[i - part.first] = body(i); }));
    for (const PathAmount& amount : amounts) {
      made += amount;
      longest = {std::max(longest.length, amount.length), std::max(longest.points, amount.points)};
    }
    first = part.last;
    const double share = static_cast<double>(first) / static_cast<double>(count);
    PM_RETURN_IF_ERROR(
        CheckAmount(limits, made, fmt::format("after {:.0f} % of the stage \"{}\"", 100.0 * share, stage)));
  }
  return run.Check();
}

}  // namespace patchmill
