#include "cam/limits/stock_columns.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "cam/limits/stock_solid.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using testing::Random;

StockColumns ColumnsOf(const Surface& stock, double top_z = kInfinity, const Surface* roughed = nullptr) {
  absl::StatusOr<StockColumns> columns = StockColumns::Make(stock, top_z, roughed, RunContext(1));
  EXPECT_TRUE(columns.ok()) << columns.status();
  return *std::move(columns);
}

// The distance from a plane is known in closed form, above it and below it.
TEST(StockColumns, DistancesFromASlope) {
  const double slope = 0.5;
  const Surface plane = testing::SurfaceOf(testing::Plane(20, 1.0, slope, 0.0));
  const StockColumns columns = ColumnsOf(plane);
  EXPECT_LT(columns.accuracy(), 0.11);  // 40 mm / 800, twice
  Random random(5);
  for (int k = 0; k < 300; ++k) {
    const Vec3 p = random.Point(-10, 10);
    const double exact = (p.z() - 1.0 - slope * p.x()) / std::hypot(1.0, slope);
    if (std::abs(exact) > 7.0) continue;  // the border of the plane is nearer
    const double found = columns.Distance(p);
    EXPECT_LE(found, exact + 1e-5) << p.transpose();
    EXPECT_GE(found, exact - columns.accuracy()) << p.transpose();
  }
}

// Whatever the surface, no place of it is outside the columns: not of folded and rational ones either.
TEST(StockColumns, ContainTheSurface) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Surface surface =
        testing::SurfaceOf(testing::RandomBspline(seed, {.folds = true, .rational = true}));
    const StockColumns columns = ColumnsOf(surface);
    Random random(seed);
    for (int k = 0; k < 500; ++k) {
      const PieceId piece(static_cast<std::size_t>(random.Int(static_cast<int>(surface.pieces.size()))));
      const Vec3 p = Position(surface.piece(piece), random.Uniform(0, 1), random.Uniform(0, 1));
      EXPECT_LE(columns.Distance(p), 0.0) << seed << " " << p.transpose();
      EXPECT_GE(columns.TopNear(Xy(p), Xy(p), 1e-9), p.z());
    }
  }
}

// A box of 20 x 20 x 6 with vertical walls, as a model and as a prism.
TEST(StockColumns, OfABoxAreThoseOfAPrism) {
  const Surface box = testing::SurfaceOf(testing::Block(10.0, 6.0, 10.001));
  const absl::StatusOr<StockSolid> model = StockSolid::OfModel(box, 6.0, nullptr, RunContext(1));
  ASSERT_TRUE(model.ok()) << model.status();
  const StockSolid prism =
      StockSolid::Whole(Outline({Ring{{-10, -10}, {10, -10}, {10, 10}, {-10, 10}}}), 6.0);
  const double near = ColumnsOf(box).accuracy();
  EXPECT_EQ(model->accuracy(), 0.0);
  for (const Vec3& c : {Vec3(0, 0, 9), Vec3(14, 0, 3), Vec3(14, 0, 9), Vec3(13, 14, 18), Vec3(0, 0, 5)}) {
    EXPECT_LE(model->Distance(c), prism.Distance(c) + 1e-5) << c.transpose();
    EXPECT_GE(model->Distance(c), prism.Distance(c) - near) << c.transpose();
  }
  EXPECT_TRUE(model->SegmentComesNearer({-20, 0, 7}, {20, 0, 7}, 1.01));
  EXPECT_FALSE(model->SegmentComesNearer({-20, 0, 7}, {20, 0, 7}, 0.99));
  // At this height the straight way passes the corner, and the corner of the rectangle does not.
  EXPECT_FALSE(model->SegmentComesNearer({25, 0, 3}, {0, -25, 3}, 0.5));
  EXPECT_TRUE(model->RectangleComesNearer({25, 0}, {0, -25}, 3.0, 0.5));
  EXPECT_FALSE(model->RectangleComesNearer({25, 0}, {0, -25}, 6.6, 0.5));
  EXPECT_NEAR(model->TopNear({14, 0}, {14, 0}, 4.1), 6.0, 1e-5);
  EXPECT_EQ(model->TopNear({14, 0}, {14, 0}, 3.8), -kInfinity);
  // A cylinder beside the box, over it, and in it.
  EXPECT_NEAR(model->CylinderRoom({14, 0}, 3.0, 1.0), 3.0, near);
  EXPECT_NEAR(model->CylinderRoom({0, 0}, 8.0, 1.0), 2.0, 1e-5);
  EXPECT_NEAR(model->CylinderRoom({10.5, 0}, 2.0, 1.5), -1.0, near);
}

TEST(StockColumns, EndAtTheTopThatIsGiven) {
  const Surface dome = testing::SurfaceOf(testing::Sphere(Vec3::Zero(), 10.0, testing::Half::kUpper));
  const StockColumns columns = ColumnsOf(dome, 4.0);
  EXPECT_NEAR(columns.Distance({0, 0, 9}), 5.0, 1e-5);
  EXPECT_NEAR(columns.TopNear({-20, -20}, {20, 20}, 1.0), 4.0, 1e-5);
}

// Over the part the stock has been cut down: there are no columns, and beside it they stand.
TEST(StockColumns, StandBesideThePartThatWasRoughed) {
  const Surface slab = testing::SurfaceOf(testing::Plane(20, 5.0));
  const Surface part = testing::SurfaceOf(testing::Plane(8));
  const StockColumns columns = ColumnsOf(slab, kInfinity, &part);
  EXPECT_NEAR(columns.Distance({0, 0, 2}), 8.0, columns.accuracy());
  EXPECT_LT(columns.Distance({14, 0, 2}), -2.9);
  EXPECT_FALSE(columns.RectangleComesNearer({-5, -5}, {5, 5}, -kInfinity, 2.8));
  EXPECT_TRUE(columns.RectangleComesNearer({-5, -5}, {5, 5}, -kInfinity, 3.2));
  EXPECT_EQ(columns.TopNear({-5, -5}, {5, 5}, 2.8), -kInfinity);
}

TEST(StockColumns, AreNotMadeOnceTheJobIsCancelled) {
  RunContext run(1);
  run.Cancel();
  const Surface slab = testing::SurfaceOf(testing::Plane(20, 5.0));
  EXPECT_FALSE(StockColumns::Make(slab, 5.0, nullptr, run).ok());
}

}  // namespace
}  // namespace patchmill
