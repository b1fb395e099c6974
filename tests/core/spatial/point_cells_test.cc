// Points found by their cells, against all pairs.
#include "core/spatial/point_cells.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

std::vector<Vec3> RandomPoints(Random& random, int count, double size) {
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    Vec3 p = random.Point(-size, size);
    if (i % 5 == 0 && i > 0) p = points.back();  // twice the same place
    if (i % 7 == 0) p = p.array().round();       // on the cells' borders, at times
    points.push_back(p);
  }
  return points;
}

TEST(PointCells, JoinThoseWithinReach) {
  Random random(11);
  for (int round = 0; round < 60; ++round) {
    const std::vector<Vec3> points = RandomPoints(random, 120, 10.0);
    const double reach = random.Uniform(0.5, 4.0);
    UnionFind expected(points.size()), found(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        if ((points[i] - points[k]).squaredNorm() <= reach * reach) expected.Join(i, k);
      }
    }
    PointCells(points, reach).JoinNear(found, RunContext(1));
    for (std::size_t i = 0; i < points.size(); ++i) ASSERT_EQ(found.Find(i), expected.Find(i)) << i;
  }
}

// Sets that others have joined before stay so, and stand for all that is near one of theirs.
TEST(PointCells, JoinOnTopOfWhatIsJoined) {
  const std::vector<Vec3> points = {{0, 0, 0}, {9, 0, 0}, {0, 0.5, 0}, {9, 0, 0.5}};
  UnionFind sets(points.size());
  sets.Join(0, 1);
  PointCells(points, 1.0).JoinNear(sets, RunContext(1));
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(sets.Find(i), 0u);
}

TEST(PointCells, VisitAllThatAreNear) {
  Random random(13);
  for (int round = 0; round < 60; ++round) {
    const std::vector<Vec3> points = RandomPoints(random, 1 + 3 * round, 10.0);
    const PointCells cells(points, random.Uniform(0.5, 6.0));
    for (int k = 0; k < 20; ++k) {
      const Vec3 place = random.Point(-14.0, 14.0);
      const double reach = random.Uniform(0.0, 8.0);
      std::vector<std::size_t> expected, found;
      for (std::size_t i = 0; i < points.size(); ++i)
        if ((points[i] - place).norm() <= reach) expected.push_back(i);
      cells.Near(place, reach, [&](std::size_t i) { found.push_back(i); });
      std::sort(found.begin(), found.end());
      EXPECT_EQ(found, expected);
    }
  }
  PointCells().Near(Vec3::Zero(), 1.0, [](std::size_t) { ADD_FAILURE(); });
}

TEST(PointCells, FindTheNearest) {
  Random random(12);
  for (int round = 0; round < 60; ++round) {
    const std::vector<Vec3> points = RandomPoints(random, 1 + 3 * round, 10.0);
    const PointCells cells(points, random.Uniform(0.5, 6.0));
    for (int k = 0; k < 40; ++k) {
      const double size = k < 30 ? 12.0 : 60.0;  // some far outside
      const Vec3 place = random.Point(-size, size);
      std::size_t best = 0;
      for (std::size_t i = 1; i < points.size(); ++i) {
        if ((points[i] - place).squaredNorm() < (points[best] - place).squaredNorm()) best = i;
      }
      EXPECT_EQ(cells.Nearest(place), best);
    }
  }
  EXPECT_EQ(PointCells({}, 1.0).Nearest(Vec3::Zero()), std::nullopt);
}

}  // namespace
}  // namespace patchmill
