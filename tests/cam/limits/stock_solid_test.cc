#include "cam/limits/stock_solid.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

Outline Square(double half) {
  return Outline({Ring{{-half, -half}, {half, -half}, {half, half}, {-half, half}}});
}

TEST(StockSolid, DistancesToABlock) {
  const StockSolid block = StockSolid::Whole(Square(10.0), 5.0);
  EXPECT_EQ(block.accuracy(), 0.0);
  EXPECT_DOUBLE_EQ(block.Distance({0, 0, 8}), 3.0);       // above
  EXPECT_DOUBLE_EQ(block.Distance({13, 0, -100}), 3.0);   // beside; it has no lower end
  EXPECT_DOUBLE_EQ(block.Distance({13, 0, 9}), 5.0);      // from the upper edge
  EXPECT_DOUBLE_EQ(block.Distance({13, 14, 17}), 13.0);   // from a corner
  EXPECT_DOUBLE_EQ(block.Distance({0, 0, 4}), -1.0);      // inside, below the top
  EXPECT_DOUBLE_EQ(block.Distance({9.5, 0, -30}), -0.5);  // inside, beside a side
  EXPECT_TRUE(block.SegmentComesNearer({-20, 0, 7}, {20, 0, 7}, 2.5));
  EXPECT_FALSE(block.SegmentComesNearer({-20, 0, 7}, {20, 0, 7}, 2.0));
  EXPECT_TRUE(block.SegmentComesNearer({12, -20, 0}, {12, 20, 0}, 2.1));
  EXPECT_FALSE(block.SegmentComesNearer({12, -20, 0}, {12, 20, 0}, 1.9));
  // The straight way passes beside the corner; the rectangle contains it.
  EXPECT_FALSE(block.SegmentComesNearer({25, 0, 0}, {0, -25, 0}, 0.5));
  EXPECT_TRUE(block.RectangleComesNearer({25, 0}, {0, -25}, 0.5));
}

// The surface is a dome of radius 20, and the block stands around it.
TEST(StockSolid, StandsAroundTheSurface) {
  const Surface dome = testing::SurfaceOf(testing::Sphere(Vec3::Zero(), 20.0, testing::Half::kUpper));
  const absl::StatusOr<StockSolid> solid = StockSolid::Roughed(Square(30.0), 8.0, dome, RunContext());
  ASSERT_TRUE(solid.ok()) << solid.status();
  EXPECT_LT(solid->accuracy(), 0.06);
  for (double angle = 0.05; angle < 6.3; angle += 0.31) {
    const Vec2 out(std::cos(angle), std::sin(angle));
    for (const double r : {0.0, 7.0, 15.0, 19.5, 20.1}) {
      EXPECT_NEAR(solid->PlanDistance(r * out), 20.0 - r, solid->accuracy()) << r << " " << angle;
    }
    for (const double r : {45.0, 80.0}) {
      const Vec2 q = r * out;
      const Vec2 beyond = (q.cwiseAbs() - Vec2::Constant(30.0)).cwiseMax(0.0);
      EXPECT_NEAR(solid->PlanDistance(q), beyond.norm(), solid->accuracy()) << r << " " << angle;
    }
  }
  EXPECT_LT(solid->PlanDistance({25, 0}), -4.0);
  EXPECT_LT(solid->PlanDistance({29.9, 29.9}), 0.0);
  EXPECT_NEAR(solid->Distance({0, 0, 8.0 + 3.0}), std::hypot(20.0, 3.0), solid->accuracy());
}

// Stock that stands apart from the surface, beyond the grid over it.
TEST(StockSolid, StandsApartFromTheSurface) {
  const Surface plane = testing::SurfaceOf(testing::Plane(10.0));
  const Outline apart({Ring{{12, -20}, {20, -20}, {20, 20}, {12, 20}}});
  const absl::StatusOr<StockSolid> solid = StockSolid::Roughed(apart, 2.0, plane, RunContext());
  ASSERT_TRUE(solid.ok()) << solid.status();
  for (double x = -15.0; x <= 30.0; x += 0.7) {
    const double expected = std::max(12.0 - x, x - 20.0);
    // Over the grid the distance may be taken as smaller, never as larger.
    EXPECT_LE(solid->PlanDistance({x, 0}), expected + solid->accuracy()) << x;
    if (std::abs(x) > 10.2) {
      EXPECT_NEAR(solid->PlanDistance({x, 0}), expected, solid->accuracy()) << x;
    }
  }
  EXPECT_TRUE(solid->SegmentComesNearer({0, 0, 4.5}, {30, 0, 4.5}, 3.0));
  EXPECT_FALSE(solid->SegmentComesNearer({0, 0, 4.5}, {8, 0, 4.5}, 3.0));
  EXPECT_TRUE(solid->RectangleComesNearer({0, 0}, {30, 1}, 3.0));
}

TEST(StockSolid, NothingStandsWhereTheSurfaceCoversTheOutline) {
  const Surface plane = testing::SurfaceOf(testing::Plane(12.0));
  const absl::StatusOr<StockSolid> solid = StockSolid::Roughed(Square(10.0), 8.0, plane, RunContext());
  ASSERT_TRUE(solid.ok()) << solid.status();
  EXPECT_GT(solid->PlanDistance({0, 0}), 20.0);
  EXPECT_FALSE(solid->RectangleComesNearer({-11, -11}, {11, 11}, 3.0));
}

TEST(StockSolid, CancelledRunsEnd) {
  const Surface plane = testing::SurfaceOf(testing::Plane(12.0));
  RunContext run;
  run.Cancel();
  EXPECT_EQ(StockSolid::Roughed(Square(10.0), 8.0, plane, run).status().code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace patchmill
