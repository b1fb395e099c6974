#include "core/fairing/box_minimum.h"

#include <algorithm>

namespace patchmill {
namespace {

using Hold = BoxQuadratic::Hold;

Hold Revised(const BoxQuadratic& f, const std::vector<double>& x, std::size_t i, Hold hold) {
  if (f.lower[i] == f.upper[i]) return hold;
  switch (hold) {
    case Hold::kFree:
      return x[i] < f.lower[i] ? Hold::kLower : (x[i] > f.upper[i] ? Hold::kUpper : Hold::kFree);
    case Hold::kLower:  // stays held as long as a larger x would not lower the value
      return f.slope(x, i) < 0.0 ? Hold::kFree : Hold::kLower;
    case Hold::kUpper:
      return f.slope(x, i) > 0.0 ? Hold::kFree : Hold::kUpper;
  }
  return hold;
}

}  // namespace

BoxStep MinimizeInBox(const BoxQuadratic& f) {
  const std::size_t n = f.lower.size();
  std::vector<Hold> holds(n, Hold::kFree);
  for (std::size_t i = 0; i < n; ++i) {
    if (f.lower[i] == f.upper[i]) holds[i] = Hold::kLower;
  }
  BoxStep step;
  while (step.solves < kMaxBoxSolves) {
    step.x = f.solve(holds);
    ++step.solves;
    bool changed = false;
    std::vector<Hold> next(n);
    for (std::size_t i = 0; i < n; ++i) {
      next[i] = Revised(f, step.x, i, holds[i]);
      changed = changed || next[i] != holds[i];
    }
    if (!changed) {
      step.exact = true;
      return step;
    }
    holds = std::move(next);
  }
  step.x.assign(n, 0.0);
  for (int sweep = 0; sweep < kBoxSweeps; ++sweep) {
    for (std::size_t i = 0; i < n; ++i) {
      if (f.lower[i] == f.upper[i]) continue;
      step.x[i] = std::clamp(step.x[i] - f.slope(step.x, i) / f.diagonal[i], f.lower[i], f.upper[i]);
    }
  }
  return step;
}

}  // namespace patchmill
