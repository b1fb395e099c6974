#include "cam/picture/label_places.h"

#include <gtest/gtest.h>

namespace patchmill {
namespace {

std::array<Vec2, 4> Rectangle(double x0, double y0, double x1, double y1) {
  return {Vec2(x0, y0), Vec2(x1, y0), Vec2(x1, y1), Vec2(x0, y1)};
}

TEST(LabelPlaces, AreInTheMiddleOfWhatIsSeen) {
  LabelPlaces places({100, 50}, {400, 400});
  places.Paint(Rectangle(120, 60, 320, 260), 0);
  places.Paint(Rectangle(120, 60, 420, 140), 2);   // hides a part of it
  places.Paint(Rectangle(120, 300, 420, 306), 1);  // no room
  const auto found = places.Find(4, 14.0);
  ASSERT_EQ(found.size(), 4u);
  ASSERT_TRUE(found[0] && found[2]);
  EXPECT_GT(found[0]->x(), 120 + 50);  // of [120,320] x [140,260] the middle line
  EXPECT_LT(found[0]->x(), 320 - 50);
  EXPECT_NEAR(found[0]->y(), 200, 6);
  EXPECT_NEAR(found[2]->y(), 100, 6);
  EXPECT_FALSE(found[1]);
  EXPECT_FALSE(found[3]);
}

TEST(LabelPlaces, TriangularAndMirroredQuadranglesArePainted) {
  LabelPlaces places({0, 0}, {200, 200});
  places.Paint({Vec2(10, 10), Vec2(10, 110), Vec2(110, 110), Vec2(110, 10)}, 0);      // the other way round
  places.Paint({Vec2(120, 120), Vec2(120, 120), Vec2(190, 120), Vec2(120, 190)}, 1);  // a side of no length
  const auto found = places.Find(2, 10.0);
  ASSERT_TRUE(found[0] && found[1]);
  EXPECT_NEAR(found[0]->x(), 60, 6);
  EXPECT_LT(found[1]->sum(), 120 + 190);
  EXPECT_GT(found[1]->minCoeff(), 120);
}

}  // namespace
}  // namespace patchmill
