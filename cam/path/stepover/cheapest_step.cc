#include "cam/path/stepover/cheapest_step.h"

#include <algorithm>

#include "cam/path/stepover/step_over.h"
#include "core/base/vec.h"

namespace patchmill {

double CheapestStep(std::vector<StepNeed>& needs, double least, double most) {
  // Number of quantiles tried, less one.
  constexpr int kShares = 16;
  std::sort(needs.begin(), needs.end(), [](const StepNeed& a, const StepNeed& b) {
    return a.step < b.step || (a.step == b.step && a.weight < b.weight);
  });
  double total = 0.0;
  for (const StepNeed& need : needs) total += need.weight;
  double best = most, best_cost = kInfinity, last = -1.0, passed = 0.0;
  int share = 0;
  for (std::size_t i = 0; i < needs.size(); ++i) {
    passed += needs[i].weight;
    if (passed < total * share / kShares && i + 1 < needs.size()) continue;
    while (share <= kShares && passed >= total * share / kShares) ++share;
    const double step = std::clamp(needs[i].step, least, most);
    if (step == last) continue;
    last = step;
    double cost = 0.0;
    for (const StepNeed& need : needs) cost += need.weight * PartsOfGap(step, need.step, least);
    cost /= step;
    if (cost < best_cost) {
      best_cost = cost;
      best = step;
    }
  }
  return best;
}

}  // namespace patchmill
