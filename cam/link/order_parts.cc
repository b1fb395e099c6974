#include "cam/link/order_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "core/base/union_find.h"

namespace patchmill {
namespace {

constexpr double kLevel = 0.01;  // mm; heights within this count as equal

// Lists of components, rising. Index: component; one more entry stands for parts that lie in none.
using Places = std::vector<std::vector<std::size_t>>;

void SortEach(Places& places) {
  for (auto& own : places) {
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
  }
}

// For each component itself and those that share a border with it.
Places Neighbours(const RegionMap& map) {
  Places beside(map.component_region.size() + 1);
  for (std::size_t i = 0; i < beside.size(); ++i) beside[i].push_back(i);
  for (const BorderLine& line : map.border_lines) {
    if (line.component == kNoComponent || line.other_component == kNoComponent) continue;
    const std::size_t a = line.component.index(), b = line.other_component.index();
    beside[a].push_back(b);
    beside[b].push_back(a);
  }
  SortEach(beside);
  return beside;
}

// For each connected unreachable area the reachable components around it, if there are at least two.
Places AroundUnreachable(const RegionMap& map, const Places& beside) {
  const auto reached = [&](std::size_t i) {
    if (i >= map.component_region.size()) return true;
    return map.regions[map.component_region[i].index()].kind != RegionKind::kUnreachable;
  };
  UnionFind sets(beside.size());
  for (std::size_t i = 0; i < beside.size(); ++i) {
    for (const std::size_t k : beside[i]) {
      if (!reached(i) && !reached(k)) sets.Join(i, k);
    }
  }
  Places around(beside.size());
  for (std::size_t i = 0; i < beside.size(); ++i) {
    for (const std::size_t k : beside[i]) {
      if (!reached(i) && reached(k)) around[sets.Find(i)].push_back(k);
    }
  }
  SortEach(around);
  std::erase_if(around, [](const auto& places) { return places.size() < 2; });
  return around;
}

}  // namespace

std::vector<std::size_t> OrderParts(const RegionMap& map, const std::vector<JobPart>& parts,
                                    const RunContext& run) {
  const Places beside = Neighbours(map), around_unreachable = AroundUnreachable(map, beside);
  const std::size_t n = parts.size(), nowhere = map.component_region.size();
  Places places(n);
  std::vector<long long> level(n);
  for (std::size_t i = 0; i < n; ++i) {
    level[i] = std::llround(parts[i].height / kLevel);
    for (const ComponentId component : parts[i].components) places[i].push_back(component.index());
    if (places[i].empty()) places[i].push_back(nowhere);
  }
  // [component]: its parts, the next one last. The others wait for this one.
  Places left(nowhere + 1);
  for (std::size_t i = n; i-- > 0;) {
    for (const std::size_t place : places[i]) left[place].push_back(i);
  }
  for (auto& own : left) {
    std::stable_sort(own.begin(), own.end(),
                     [&](std::size_t a, std::size_t b) { return level[a] < level[b]; });
  }
  std::vector<bool> done(n, false), near(nowhere + 1, false);
  // [part]: the last step in which it was looked at, because it may be the next one of several components.
  std::vector<std::size_t> asked(n, 0);
  // The greatest height of the parts that are left in these components.
  constexpr long long kNothing = std::numeric_limits<long long>::min();
  const auto highest = [&](const std::vector<std::size_t>& of) {
    long long high = kNothing;
    for (const std::size_t place : of)
      if (!left[place].empty()) high = std::max(high, level[left[place].back()]);
    return high;
  };
  Places components_beside(nowhere + 1);
  for (std::size_t g = 0; g < around_unreachable.size(); ++g) {
    for (const std::size_t place : around_unreachable[g]) components_beside[place].push_back(g);
  }
  std::vector<long long> across(around_unreachable.size());
  const auto waits = [&](std::size_t i) {
    for (const std::size_t place : places[i]) {
      if (highest(beside[place]) > level[i]) return true;
      for (const std::size_t g : components_beside[place])
        if (across[g] > level[i]) return true;
    }
    return false;
  };
  std::vector<std::size_t> order;
  while (order.size() < n && !run.Cancelled()) {
    for (std::size_t g = 0; g < around_unreachable.size(); ++g) across[g] = highest(around_unreachable[g]);
    // The highest part of all need not wait, so there always is one.
    using Rank = std::tuple<bool, long long, std::size_t>;
    Rank best{true, std::numeric_limits<long long>::max(), n};
    for (const auto& own : left) {
      if (own.empty() || asked[own.back()] == order.size() + 1) continue;
      const std::size_t i = own.back();
      asked[i] = order.size() + 1;
      if (waits(i)) continue;
      const bool far =
          std::none_of(places[i].begin(), places[i].end(), [&](std::size_t p) { return near[p]; });
      best = std::min(best, Rank{far, -level[i], i});
    }
    const std::size_t next = std::get<2>(best);
    order.push_back(next);
    done[next] = true;
    std::fill(near.begin(), near.end(), false);
    for (const std::size_t place : places[next]) {
      for (const std::size_t other : beside[place]) near[other] = true;
      while (!left[place].empty() && done[left[place].back()]) left[place].pop_back();
    }
  }
  return order;
}

}  // namespace patchmill
