#include "cam/picture/move_lines.h"

#include <algorithm>
#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace patchmill {
namespace {

// A full circle is drawn as one: its ends are the same place.
TEST(MoveLines, ArcsAreDrawnAsArcs) {
  Toolpath path;
  path.moves = {{.kind = MoveKind::kRapid, .to = Vec3(5, 0, 0)},
                {.kind = MoveKind::kCut, .to = Vec3(5, 0, 0), .feed = 100.0}};
  path.moves[1].arc = Arc{ArcPlane::kXy, Vec2::Zero(), false};
  PreviewInput input;
  input.toolpath = &path;
  View view = TopView();
  view.scale = 10.0;
  view.origin = Vec2(100, 100);
  SvgWriter svg(200, 200);
  DrawMoves(input, view, MoveLine::kZigzag, 1.0, svg);
  const std::string text = std::move(svg).Finish();
  EXPECT_NE(text.find("50.00,100.00"), std::string::npos) << text;
  // From one vertex to the next it is at least 1 px of 314.
  const auto vertices = std::count(text.begin(), text.end(), ',');
  EXPECT_GT(vertices, 30);
  EXPECT_LT(vertices, 330);
}

}  // namespace
}  // namespace patchmill
