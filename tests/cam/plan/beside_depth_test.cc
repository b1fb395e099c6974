#include "cam/plan/beside_depth.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/support/jobs/jobs.h"
#include "tests/support/walls.h"

namespace patchmill {
namespace {

// From (0, 0, 0) to (40, 30, 12).
Surface SurfaceOfBlock() { return testing::PlacedSurface(testing::ClosedBlock(40.0, 30.0, 12.0)); }

std::optional<BesideDepth> Deepest(const std::vector<Vec3>& tips) {
  const Surface surface = SurfaceOfBlock();
  const auto found = DeepestBeside(surface, tips, 3.0, RunContext());
  EXPECT_TRUE(found.ok());
  return found.ok() ? *found : std::nullopt;
}

TEST(DeepestBeside, IsTheLowestTipOutsideHoweverFarAway) {
  const Box3 box = SurfaceOfBlock().box;
  const double top = box.max.z(), right = box.max.x(), middle = 0.5 * (box.min.y() + box.max.y());
  for (const double away : {0.4, 3.0, 11.0, 14.0, 300.0}) {
    const auto found = Deepest(
        {{right - 5.0, middle, top}, {right + away, middle, top - 9.0}, {right + 1.0, middle, top - 2.0}});
    ASSERT_TRUE(found) << away;
    EXPECT_DOUBLE_EQ(found->tip.x(), right + away);
    EXPECT_DOUBLE_EQ(found->below_top, 9.0);
  }
}

TEST(DeepestBeside, BeginsHalfTheRadiusBelowTheTop) {
  const Box3 box = SurfaceOfBlock().box;
  const Vec3 beside(box.max.x() + 2.0, 0.5 * (box.min.y() + box.max.y()), box.max.z());
  EXPECT_TRUE(Deepest({beside - Vec3(0, 0, 1.51)}));
  EXPECT_FALSE(Deepest({beside - Vec3(0, 0, 1.49)}));
  EXPECT_FALSE(Deepest({beside + Vec3(0, 0, 5.0)}));
  EXPECT_FALSE(Deepest({}));
}

TEST(TipsOf, LeavesOutWhatIsAboveEverything) {
  ProgramMotion motion;
  motion.moves.resize(3);
  motion.moves[0].to_above = true;
  motion.moves[1].to = Vec3(1, 2, 3);
  motion.moves[2].to = Vec3(4, 5, 6);
  const std::vector<Vec3> tips = TipsOf(motion, Vec3(10, 20, 30));
  ASSERT_EQ(tips.size(), 2u);
  EXPECT_EQ(tips[0], Vec3(11, 22, 33));
  EXPECT_EQ(tips[1], Vec3(14, 25, 36));
}

}  // namespace
}  // namespace patchmill
