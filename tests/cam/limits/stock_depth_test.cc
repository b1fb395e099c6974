// Stock that stands deeper on walls than on floors, or the other way round.
#include "cam/limits/stock_depth.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "cam/limits/stock_solid.h"
#include "cam/verify/stock_moves.h"

namespace patchmill {
namespace {

Ring Block() { return {{0, 0}, {20, 0}, {20, 20}, {0, 20}}; }

// Along a normal the stock reaches as far as the farthest place of the body by which it thickens the part: a
// ball that was moved upwards, or sideways.
TEST(StockDepth, IsTheReachOfTheBodyThatThickensThePart) {
  for (const StockDepth depth : {StockDepth(0.2, 0.5), StockDepth(0.5, 0.2), StockDepth(0.3)}) {
    const double up = std::max(0.0, depth.floors - depth.walls),
                 out = std::max(0.0, depth.walls - depth.floors);
    for (int k = 0; k <= 18; ++k) {
      const double slope = Radians(5.0 * k);
      const Vec3 normal(std::sin(slope), 0.0, std::cos(slope));
      double reach = 0.0;
      for (const Vec3& middle : {Vec3(out, 0, up), Vec3(out, 0, -up), Vec3(-out, 0, up)})
        reach = std::max(reach, (middle + depth.Least() * normal).dot(normal));
      EXPECT_NEAR(depth.Along(normal.z()), reach, 1e-12) << slope;
    }
    EXPECT_NEAR(depth.Along(1.0), depth.floors, 1e-12);
    EXPECT_NEAR(depth.Along(0.0), depth.walls, 1e-12);
  }
}

// A ball of radius 3 beside a block and above it. It may cut 0.2 mm from the side and 0.5 mm from above.
TEST(StockDepth, ABlockIsCutAsDeepAsItsSideAllows) {
  constexpr double kRadius = 3.0, kTop = 10.0;
  const StockSolid block = StockSolid::Whole(Outline({Block()}), kTop);
  const auto cut = [&](const Vec3& c, const StockDepth& limit) {
    return FindDeepCuts(block, {{c, c + Vec3(0, 5, 0), 7}}, kRadius, limit, RunContext());
  };
  const auto beside = [&](double depth) { return Vec3(depth - kRadius, 5, 4); };
  const auto above = [&](double depth) { return Vec3(10, 5, kTop + kRadius - depth); };
  for (const StockDepth limit : {StockDepth(0.2, 0.5), StockDepth(0.5, 0.2)}) {
    EXPECT_EQ(cut(beside(limit.walls - 0.01), limit).move, -1);
    EXPECT_EQ(cut(above(limit.floors - 0.01), limit).move, -1);
    const DeepCuts side = cut(beside(limit.walls + 0.01), limit),
                   top = cut(above(limit.floors + 0.01), limit);
    EXPECT_EQ(side.move, 7);
    EXPECT_NEAR(side.deepest, limit.walls + 0.01, 1e-9);
    EXPECT_NEAR(side.limit, limit.walls, 1e-5);
    EXPECT_EQ(top.move, 7);
    EXPECT_NEAR(top.deepest, limit.floors + 0.01, 1e-9);
    EXPECT_NEAR(top.limit, limit.floors, 1e-5);
  }
  // At the edge the ball comes from 45 degrees.
  const StockDepth limit(0.2, 0.5);
  const double allowed = 0.2 + 0.3 * std::sqrt(0.5);
  const auto edge = [&](double depth) {
    const double away = (kRadius - depth) * std::sqrt(0.5);
    return Vec3(-away, 5, kTop + away);
  };
  EXPECT_EQ(cut(edge(allowed - 0.01), limit).move, -1);
  EXPECT_EQ(cut(edge(allowed + 0.01), limit).move, 7);
}

}  // namespace
}  // namespace patchmill
