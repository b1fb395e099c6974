// Near points of a list, against all of them.
#include "core/spatial/point_list.h"

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace patchmill {
namespace {

using testing::Random;

TEST(PointList, NoNearPointIsPassedByAndHardlyAnyOther) {
  Random random(23);
  for (const double at : {0.0, 3.0, 1e4}) {
    PointList list;
    std::vector<Vec3> points;
    for (int i = 0; i < 61; ++i) {
      points.push_back(random.Point(at - 10.0, at + 10.0));
      list.Add(points.back());
      ASSERT_EQ(list.size(), points.size());
      const Vec3 p = random.Point(at - 12.0, at + 12.0);
      const double distance = random.Uniform(0.0, 15.0), slack = 3e-4;
      std::size_t next = list.FirstNear(p, distance, 0);
      for (std::size_t k = 0; k < points.size(); ++k) {
        const double d = (points[k] - p).norm();
        if (k == next) {
          EXPECT_LT(d, distance + slack);
          next = list.FirstNear(p, distance, k + 1);
        } else {
          EXPECT_GE(d, distance);
        }
      }
      EXPECT_EQ(next, points.size());
      EXPECT_EQ(list.FirstNear(p, kInfinity, 0), 0u);
      EXPECT_EQ(list.FirstNear(p, kInfinity, points.size()), points.size());
    }
  }
}

TEST(PointList, IsEmptyAtFirst) {
  EXPECT_EQ(PointList().FirstNear(Vec3::Zero(), kInfinity, 0), 0u);
  EXPECT_EQ(PointList().size(), 0u);
}

}  // namespace
}  // namespace patchmill
