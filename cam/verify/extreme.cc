#include "cam/verify/extreme.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/base/status.h"

namespace patchmill {

absl::StatusOr<Extremes> SearchRoots(const std::vector<CellRect>& roots, const SearchStart& start,
                                     const MakeRootSearch& make, const RunContext& run, const char* stage) {
  // Every kFirst-th root is searched in the first round; kChunk roots form one task.
  constexpr std::size_t kFirst = 8, kChunk = 32;
  std::vector<std::size_t> first, second;
  for (std::size_t i = 0; i < roots.size(); ++i) (i % kFirst == 0 ? first : second).push_back(i);
  std::vector<Extreme> found(roots.size());
  Extremes result;
  result.worst = start.known;
  for (const std::vector<std::size_t>* round : {&first, &second}) {
    const Threshold threshold{result.worst.value, start.limit, start.certainty};
    const std::size_t chunks = (round->size() + kChunk - 1) / kChunk;
    PM_RETURN_IF_ERROR(ParallelFor(run, round == &second ? stage : nullptr, chunks, [&](std::size_t chunk) {
      const RootSearch search = make();
      Threshold so_far = threshold;  // with the values of this chunk
      const std::size_t end = std::min(round->size(), (chunk + 1) * kChunk);
      for (std::size_t k = chunk * kChunk; k < end && !run.Cancelled(); ++k) {
        const std::size_t i = (*round)[k];
        found[i] = search(roots[i], so_far);
        so_far.known = std::max(so_far.known, found[i].value);
      }
    }));
    for (const std::size_t i : *round) {
      if (found[i].value > result.worst.value) result.worst = found[i];
    }
  }
  for (const Extreme& e : found) {
    if (e.value > start.limit) result.violations.push_back(e);
  }
  std::stable_sort(result.violations.begin(), result.violations.end(),
                   [](const Extreme& a, const Extreme& b) { return a.value > b.value; });
  return result;
}

}  // namespace patchmill
