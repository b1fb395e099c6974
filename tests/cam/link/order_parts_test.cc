#include "cam/link/order_parts.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/support/sanitized.h"

namespace patchmill {
namespace {

using Order = std::vector<std::size_t>;

// Regions, and which of them share a border.
RegionMap Map(int regions, const std::vector<std::pair<int, int>>& borders) {
  RegionMap map;
  map.regions.resize(static_cast<std::size_t>(regions));
  for (int i = 0; i < regions; ++i) map.component_region.push_back(RegionId(i));
  for (const auto& [a, b] : borders) {
    map.border_lines.push_back({.region = RegionId(a),
                                .other = RegionId(b),
                                .component = ComponentId(a),
                                .other_component = ComponentId(b),
                                .points = {}});
  }
  map.border_lines.push_back({.region = RegionId(0), .component = ComponentId(0), .points = {}});
  return map;
}

// A part with passes in these components.
JobPart Part(const std::set<int>& components, double height) {
  JobPart part{.components = {}, .height = height};
  for (const int component : components) part.components.push_back(ComponentId(component));
  return part;
}

Order Ordered(const RegionMap& map, const std::vector<JobPart>& parts) {
  return OrderParts(map, parts, RunContext(1));
}

TEST(OrderParts, NothingOfNothing) { EXPECT_TRUE(Ordered({}, {}).empty()); }

TEST(OrderParts, AHillFromTheTop) {
  // Plain, flank, cap.
  const RegionMap map = Map(3, {{0, 1}, {1, 2}});
  EXPECT_EQ(Ordered(map, {Part({0}, 3), Part({1}, 7), Part({2}, 12)}), (Order{2, 1, 0}));
}

TEST(OrderParts, APitFromTheRim) {
  const RegionMap map = Map(3, {{0, 1}, {1, 2}});
  EXPECT_EQ(Ordered(map, {Part({0}, -7), Part({1}, -3), Part({2}, 2)}), (Order{2, 1, 0}));
}

TEST(OrderParts, OneHillAfterTheOtherAndSurfaceAfterBoth) {
  // 0 plain; 1, 2 flank and cap of a hill; 3, 4 those of a lower hill; 5, 6 wall and floor of a pit.
  const RegionMap map = Map(7, {{0, 1}, {1, 2}, {0, 3}, {3, 4}, {0, 5}, {5, 6}});
  const std::vector<JobPart> parts{Part({1}, 7),  Part({3}, 6),  Part({5}, 0), Part({0}, 2),
                                   Part({2}, 12), Part({4}, 10), Part({6}, -4)};
  EXPECT_EQ(Ordered(map, parts), (Order{4, 0, 5, 1, 3, 2, 6}));
}

TEST(OrderParts, ANeighbourGoesBeforeWhatIsHigherButFarAway) {
  // Two tables, each beside a step lower than both of them.
  const RegionMap map = Map(4, {{0, 1}, {2, 3}});
  EXPECT_EQ(Ordered(map, {Part({0}, 10), Part({1}, 5), Part({2}, 9), Part({3}, 4)}), (Order{0, 1, 2, 3}));
  EXPECT_EQ(Ordered(Map(4, {}), {Part({0}, 10), Part({1}, 5), Part({2}, 9), Part({3}, 4)}),
            (Order{0, 2, 1, 3}));
}

TEST(OrderParts, SurfaceAroundAFootThatNoBallGetsIntoWaits) {
  // 0 plain; 1 flank of a boss; 2, 3 its foot, unreachable for two reasons; 4 a hill beside the plain.
  RegionMap map = Map(5, {{0, 2}, {2, 3}, {3, 1}, {0, 4}});
  const std::vector<JobPart> parts{Part({0}, 2), Part({1}, 6), Part({4}, 8)};
  EXPECT_EQ(Ordered(map, parts), (Order{2, 0, 1}));  // as long as passes may lie there
  map.regions[2].kind = map.regions[3].kind = RegionKind::kUnreachable;
  EXPECT_EQ(Ordered(map, parts), (Order{2, 1, 0}));
}

TEST(OrderParts, AThousandRegionsUnderOnePartAreSoonDone) {
  // Each step may look at a part of many regions once, not once in each of them.
  const int n = 2000;
  std::vector<std::pair<int, int>> chain;
  std::vector<JobPart> parts(1);
  for (int i = 0; i < n; ++i) {
    if (i > 0) chain.emplace_back(i - 1, i);
    parts[0].components.push_back(ComponentId(i));
    parts.push_back(Part({i}, 1.0 + i));
  }
  const auto start = std::chrono::steady_clock::now();
  const Order order = Ordered(Map(n, chain), parts);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(testing::kSanitized ? 20 : 2));
  ASSERT_EQ(order.size(), parts.size());
  EXPECT_EQ(order.back(), 0u);
}

TEST(OrderParts, ThousandsOfIslandsInOneSlotAreSoonDone) {
  // All are beside each other, with nothing but the slot between.
  const int n = 3000;
  std::vector<std::pair<int, int>> borders;
  std::vector<JobPart> parts;
  for (int i = 1; i <= n; ++i) {
    borders.emplace_back(0, i);
    parts.push_back(Part({i}, static_cast<double>(i % 7)));
  }
  RegionMap map = Map(n + 1, borders);
  map.regions[0].kind = RegionKind::kUnreachable;
  const auto start = std::chrono::steady_clock::now();
  const Order order = Ordered(map, parts);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(testing::kSanitized ? 20 : 2));
  ASSERT_EQ(order.size(), parts.size());
  for (std::size_t i = 1; i < order.size(); ++i)
    EXPECT_LE(parts[order[i]].height, parts[order[i - 1]].height) << i;
}

TEST(OrderParts, EndsEarlyWhenCancelled) {
  RunContext run(1);
  run.Cancel();
  EXPECT_TRUE(OrderParts(Map(1, {}), {Part({0}, 1), Part({0}, 2)}, run).empty());
}

TEST(OrderParts, OfOneRegionTheHighestFirst) {
  EXPECT_EQ(Ordered(Map(1, {}), {Part({0}, 1), Part({0}, 5), Part({0}, 2), Part({0}, 8)}),
            (Order{3, 1, 2, 0}));
}

TEST(OrderParts, FlatSurfaceKeepsItsOrder) {
  EXPECT_EQ(Ordered(Map(1, {}), {Part({0}, 5.0), Part({0}, 5.001), Part({0}, 4.999)}), (Order{0, 1, 2}));
}

TEST(OrderParts, PassesOfNoKnownRegionGoByHeight) {
  EXPECT_EQ(Ordered({}, {Part({}, 1), Part({}, 3), Part({}, 2)}), (Order{1, 2, 0}));
}

// Whatever the map: each part once, and none before a higher one beside it.
TEST(OrderParts, NoneBeforeAHigherNeighbour) {
  testing::Random random(11);
  for (int round = 0; round < 200; ++round) {
    const int n = 2 + static_cast<int>(random.Uniform(0, 12));
    std::set<std::pair<int, int>> borders;
    for (int a = 0; a < n; ++a) {
      for (int b = a + 1; b < n; ++b) {
        if (random.Uniform(0, 1) < 0.2) borders.emplace(a, b);
      }
    }
    const RegionMap map = Map(n, {borders.begin(), borders.end()});
    std::vector<JobPart> parts;
    for (int i = 0; i < 3 * n; ++i) {
      std::set<int> regions{static_cast<int>(random.Uniform(0, n)), static_cast<int>(random.Uniform(0, n))};
      // Few heights, so that some are the same.
      parts.push_back(Part(regions, std::floor(random.Uniform(0, 9))));
    }
    const Order order = Ordered(map, parts);
    Order sorted = order;
    std::sort(sorted.begin(), sorted.end());
    ASSERT_EQ(sorted.size(), parts.size());
    for (std::size_t i = 0; i < sorted.size(); ++i) EXPECT_EQ(sorted[i], i);
    const auto beside = [&](const JobPart& one, const JobPart& other) {
      for (const ComponentId a : one.components) {
        for (const ComponentId b : other.components) {
          if (a == b || borders.count(std::minmax(a.value, b.value)) > 0) return true;
        }
      }
      return false;
    };
    for (std::size_t i = 0; i < order.size(); ++i) {
      for (std::size_t j = i + 1; j < order.size(); ++j) {
        const JobPart &first = parts[order[i]], &then = parts[order[j]];
        if (beside(first, then)) {
          EXPECT_GE(first.height, then.height) << round;
        }
      }
    }
  }
}

}  // namespace
}  // namespace patchmill
