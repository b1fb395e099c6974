#include "cam/path/parallel/split_at_walls.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patchmill {
namespace {

CutterPath PathOf(const std::vector<Vec3>& centers, bool closed = false) {
  CutterPath path;
  path.kind = PassKind::kZigzag;
  path.closed = closed;
  path.order_key = 7;
  for (const Vec3& c : centers) path.points.push_back({c, {}, {}});
  return path;
}

std::vector<std::vector<Vec3>> PartsOf(const CutterPath& path) {
  std::vector<std::vector<Vec3>> parts;
  for (const CutterPath& part : SplitAtWalls(path, 1.0)) {
    EXPECT_EQ(part.order_key, 7);
    std::vector<Vec3>& centers = parts.emplace_back();
    for (const CutterPoint& p : part.points) centers.push_back(p.center);
  }
  return parts;
}

const Vec3 a(0, 0, 5), b(4, 0, 5), c(4, 0, 2), d(9, 0, 2), e(9, 0, 6), f(12, 0, 6);

TEST(SplitAtWalls, KeepsWhatHasNone) {
  const Vec3 low(4, 0, 4.5), slope(4.5, 0, 2);
  EXPECT_THAT(PartsOf(PathOf({a, b, low})), testing::ElementsAre(std::vector{a, b, low}));  // a step
  EXPECT_THAT(PartsOf(PathOf({a, b, slope})), testing::ElementsAre(std::vector{a, b, slope}));
  const std::vector<CutterPath> round = SplitAtWalls(PathOf({a, b, d, f}, true), 1.0);
  ASSERT_EQ(round.size(), 1u);
  EXPECT_TRUE(round.front().closed);
}

TEST(SplitAtWalls, CutsBetweenTopAndFoot) {
  EXPECT_THAT(PartsOf(PathOf({a, b, c, d, e, f})),
              testing::ElementsAre(std::vector{a, b}, std::vector{c, d}, std::vector{e, f}));
  // What is left of a part is no pass.
  EXPECT_THAT(PartsOf(PathOf({b, c, d})), testing::ElementsAre(std::vector{c, d}));
}

TEST(SplitAtWalls, ClosedOnesBeginBelowAWall) {
  const std::vector<Vec3> ring = {a, b, c, d, Vec3(9, 3, 2), Vec3(0, 3, 2), Vec3(0, 3, 5)};
  EXPECT_THAT(PartsOf(PathOf(ring, true)),
              testing::ElementsAre(std::vector{c, d, ring[4], ring[5]}, std::vector{ring[6], a, b}));
  for (const CutterPath& part : SplitAtWalls(PathOf(ring, true), 1.0)) EXPECT_FALSE(part.closed);
}

}  // namespace
}  // namespace patchmill
