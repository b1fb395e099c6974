#include "cam/link/shorten_order.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/support/sanitized.h"

namespace patchmill {
namespace {

using testing::Random;

double Distance(const Vec3& a, const Vec3& b) { return (b - a).norm(); }

double TimeOf(const std::vector<Stop>& stops, const std::vector<std::size_t>& order, Vec3 at) {
  double sum = 0.0;
  for (const std::size_t s : order) {
    sum += Distance(at, stops[s].enter);
    at = stops[s].leave;
  }
  return sum;
}

bool Keeps(const std::vector<Stop>& stops, const std::vector<std::size_t>& order) {
  std::vector<bool> done(stops.size(), false);
  for (const std::size_t s : order) {
    for (const std::size_t b : stops[s].before) {
      if (!done[b]) return false;
    }
    done[s] = true;
  }
  return true;
}

std::vector<std::size_t> AsGiven(std::size_t count) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  return order;
}

// Random stops in a square of 100; each comes after some of the ones before it.
std::vector<Stop> RandomStops(Random& random, std::size_t count, double needs) {
  std::vector<Stop> stops(count);
  const auto place = [&] { return Vec3(random.Uniform(0, 100), random.Uniform(0, 100), 0); };
  for (std::size_t i = 0; i < count; ++i) {
    stops[i].enter = place();
    stops[i].leave = place();
    for (std::size_t j = 0; j < i; ++j) {
      if (random.Uniform(0, 1) < needs) stops[i].before.push_back(j);
    }
  }
  return stops;
}

TEST(ShortenOrder, TwoSidesOfAWallAreCutByTurns) {
  // One-way walls back to back: the end of one is beside the start of the other.
  constexpr std::size_t kLevels = 12;
  std::vector<Stop> stops;
  for (std::size_t level = 0; level < kLevels; ++level) {
    const double z = -static_cast<double>(level);
    stops.push_back({{0, 0, z}, {70, 0, z}, {}});
    stops.push_back({{70, 16, z}, {0, 16, z}, {}});
    for (const std::size_t side : {0u, 1u}) {
      if (level > 0) stops[2 * level + side].before = {2 * level - 2 + side};
    }
  }
  // One side down to its foot, then the other.
  std::vector<std::size_t> order;
  for (const std::size_t side : {0u, 1u}) {
    for (std::size_t level = 0; level < kLevels; ++level) order.push_back(2 * level + side);
  }
  const Vec3 from(0, 0, 0);
  const auto better = ShortenOrder(stops, order, from, Distance, RunContext(1));
  EXPECT_TRUE(Keeps(stops, better));
  // 16 across each time, a little more where the next is a level lower.
  EXPECT_LT(TimeOf(stops, better, from), 16.1 * 2 * kLevels);
  EXPECT_GT(TimeOf(stops, order, from), 70.0 * 2 * (kLevels - 1));
}

TEST(ShortenOrder, KeepsAllWhatMustComeBeforeAndNeverGetsLonger) {
  Random random(11);
  double saved = 0.0;
  for (int round = 0; round < 200; ++round) {
    const std::size_t count = 1 + static_cast<std::size_t>(random.Uniform(0, 60));
    const auto stops = RandomStops(random, count, round % 4 == 0 ? 0.0 : random.Uniform(0, 0.2));
    const Vec3 from(random.Uniform(0, 100), random.Uniform(0, 100), 0);
    const auto given = AsGiven(count);
    const auto order = ShortenOrder(stops, given, from, Distance, RunContext(1));
    EXPECT_TRUE(std::is_permutation(order.begin(), order.end(), given.begin(), given.end())) << round;
    EXPECT_TRUE(Keeps(stops, order)) << round;
    const double before = TimeOf(stops, given, from), after = TimeOf(stops, order, from);
    EXPECT_LE(after, before + 1e-9) << round;
    saved += (before - after) / before;
    EXPECT_EQ(order, ShortenOrder(stops, given, from, Distance, RunContext(1))) << round;
  }
  EXPECT_GT(saved / 200.0, 0.2);
}

TEST(ShortenOrder, NoStopCanBeMovedToAdvantage) {
  Random random(12);
  for (int round = 0; round < 30; ++round) {
    const auto stops = RandomStops(random, 30, 0.05);
    const Vec3 from(0, 0, 0);
    const auto order = ShortenOrder(stops, AsGiven(30), from, Distance, RunContext(1));
    const double time = TimeOf(stops, order, from);
    for (std::size_t i = 0; i < order.size(); ++i) {
      for (std::size_t k = 0; k < order.size(); ++k) {
        std::vector<std::size_t> moved = order;
        moved.erase(moved.begin() + static_cast<std::ptrdiff_t>(i));
        moved.insert(moved.begin() + static_cast<std::ptrdiff_t>(k), order[i]);
        if (!Keeps(stops, moved)) continue;
        EXPECT_GE(TimeOf(stops, moved, from), time - 1e-5) << round;
      }
    }
  }
}

TEST(ShortenOrder, NothingToDo) {
  EXPECT_TRUE(ShortenOrder({}, {}, Vec3::Zero(), Distance, RunContext(1)).empty());
  const std::vector<Stop> one{{Vec3::Zero(), Vec3::Zero(), {}}};
  EXPECT_EQ(ShortenOrder(one, {0}, Vec3::Zero(), Distance, RunContext(1)), std::vector<std::size_t>{0});
}

TEST(ShortenOrder, IsLeftWithinTwoHundredMilliseconds) {
  Random random(13);
  const auto stops = RandomStops(random, 60'000, 0.0);
  double best = kInfinity;
  for (int attempt = 0; attempt < 3 && best > 0.2; ++attempt) {
    RunContext run(1);
    run.set_deadline(RunContext::Clock::now() + std::chrono::milliseconds(100));
    const auto start = RunContext::Clock::now();
    const auto order = ShortenOrder(stops, AsGiven(stops.size()), Vec3::Zero(), Distance, run);
    EXPECT_EQ(order.size(), stops.size());
    best = std::min(best, std::chrono::duration<double>(RunContext::Clock::now() - start).count() - 0.1);
  }
  EXPECT_LE(best, testing::kSanitized ? 2.0 : 0.2);
}

}  // namespace
}  // namespace patchmill
