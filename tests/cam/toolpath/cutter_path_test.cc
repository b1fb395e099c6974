#include "cam/toolpath/cutter_path.h"

#include <gtest/gtest.h>

namespace patchmill {
namespace {

CutterPath Through(const std::vector<Vec3>& centers, bool closed) {
  CutterPath path;
  path.closed = closed;
  for (const Vec3& c : centers) {
    path.points.emplace_back();
    path.points.back().center = c;
  }
  return path;
}

TEST(CutterPath, LengthCountsTheClosingMove) {
  const std::vector<Vec3> box = {{0, 0, 1}, {3, 0, 1}, {3, 4, 1}};
  EXPECT_DOUBLE_EQ(Length(Through(box, false)), 7.0);
  EXPECT_DOUBLE_EQ(Length(Through(box, true)), 12.0);
  EXPECT_DOUBLE_EQ(Length(Through({{0, 0, 0}, {1, 2, 2}}, false)), 3.0);
}

TEST(CutterPath, NothingHasNoLength) {
  EXPECT_EQ(Length(Through({}, true)), 0.0);
  EXPECT_EQ(Length(Through({{1, 2, 3}}, true)), 0.0);
}

}  // namespace
}  // namespace patchmill
