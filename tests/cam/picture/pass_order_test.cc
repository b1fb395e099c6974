#include "cam/picture/pass_order.h"

#include <cmath>
#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace patchmill {
namespace {

View TenPerMm() {
  View view = TopView();
  view.scale = 10.0;
  view.origin = Vec2(0, 100);
  return view;
}

Move Cut(const Vec3& to, int pass) { return {.kind = MoveKind::kCut, .to = to, .feed = 100.0, .pass = pass}; }
Move Rapid(const Vec3& to) { return {.kind = MoveKind::kRapid, .to = to}; }

// A line to the right, one back 3 mm above it in the view, a short one, and one that lies on the first.
Toolpath Lines() {
  Toolpath path;
  path.moves = {Rapid({0, 0, 0}),  Cut({4, 0, 0}, 0),  Cut({6, 0, 0}, 0),
                Rapid({6, 3, 0}),  Cut({0, 3, 0}, 1),  Rapid({0, 6, 0}),
                Cut({1, 6, 0}, 2), Rapid({0, 0.5, 0}), Cut({6, 0.5, 0}, 3)};
  return path;
}

TEST(PassOrder, ArrowsStandInTheMiddleOfPasses) {
  const auto arrows = ArrowsOf(Lines(), TenPerMm());
  ASSERT_EQ(arrows.size(), 2u);
  EXPECT_NEAR((arrows[0].at - Vec2(30, 100)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((arrows[0].direction - Vec2(1, 0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((arrows[1].at - Vec2(30, 70)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((arrows[1].direction - Vec2(-1, 0)).norm(), 0.0, 1e-9);
}

TEST(PassOrder, AFullCircleHasAnArrowAcross) {
  Toolpath path;
  path.moves = {Rapid({5, 0, 0}), Cut({5, 0, 0}, 0)};
  path.moves[1].arc = Arc{ArcPlane::kXy, Vec2::Zero(), false};
  const auto arrows = ArrowsOf(path, TenPerMm());
  ASSERT_EQ(arrows.size(), 1u);
  EXPECT_NEAR((arrows[0].at - Vec2(-50, 100)).norm(), 0.0, 1.0);
  EXPECT_NEAR(arrows[0].direction.y(), 1.0, 0.02);  // down in the picture: counter-clockwise
}

TEST(PassOrder, NumbersStandAtTheStarts) {
  const auto starts = StartsOf(Lines(), {0, 1, 3}, TenPerMm());
  ASSERT_EQ(starts.size(), 3u);
  EXPECT_NEAR((starts[1] - Vec2(60, 70)).norm(), 0.0, 1e-9);
  const Toolpath path = Lines();
  PreviewInput input;
  input.toolpath = &path;
  input.section_passes = {0, 1, 3};
  SvgWriter svg(200, 200);
  DrawPassOrder(input, TenPerMm(), svg);
  const std::string text = std::move(svg).Finish();
  EXPECT_NE(text.find(">1</text>"), std::string::npos);
  EXPECT_NE(text.find(">2</text>"), std::string::npos);
  EXPECT_EQ(text.find(">3</text>"), std::string::npos);  // it starts where 1 does
}

}  // namespace
}  // namespace patchmill
