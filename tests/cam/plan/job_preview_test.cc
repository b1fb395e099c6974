// How the picture of a job shows areas that are not cut.
#include "cam/plan/job_preview.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cam/picture/move_lines.h"
#include "tests/support/jobs/jobs.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class RegionPicture : public ::testing::Test {
 protected:
  // A steep roof on a level plain: one region each, of 800 and 1250 mm2.
  RegionPicture() {
    model_ = Plane(20, 0, 1.2, 0);
    for (Patch& patch : Transformed(Plane(20), Eigen::Affine3d(Eigen::Translation3d(-40, 0, -24))).patches) {
      model_.patches.push_back(patch);
    }
    job_ = BallJob(3.0);
  }
  std::string Draw() {
    const Surface surface = PlacedSurface(model_);
    const auto regions = PlanRegions(surface, job_, RunContext());
    const auto resolved = Resolve(surface, job_, RunContext());
    EXPECT_TRUE(regions.ok() && resolved.ok()) << regions.status() << resolved.status();
    return DrawRegions(surface, *regions, *resolved, job_.operation.steep_angle, "roof");
  }
  PatchModel model_;
  Job job_;
};

TEST_F(RegionPicture, ShowsEveryRegionOfAWholePart) {
  EXPECT_THAT(Draw(), AllOf(HasSubstr("neutral, steep"), HasSubstr("neutral, gentle")));
}

// A valley that passes 45 degrees 0.2 mm before its open edges: two strips of less than a cell in a hundred.
TEST_F(RegionPicture, ShowsTheNarrowestRegions) {
  model_ = Quadratic(0.02526, 0, 20);
  job_.operation.steep_angle = Radians(45);
  job_.operation.detail = 1.0;
  EXPECT_THAT(Draw(), AllOf(HasSubstr("0 neutral, "), HasSubstr("1 neutral, "), HasSubstr("2 neutral, ")));
}

// If there are more regions than the legend has rows, it names the largest ones. Unreachable areas come
// last, however large they are.
TEST_F(RegionPicture, NamesTheLargest) {
  model_ = Transformed(Plane(20), Eigen::Affine3d(Eigen::Translation3d(0, 0, -30)));
  for (int i = 0; i < 30; ++i) {
    const double side = 5.0 + 0.1 * i;
    for (Patch& patch : Transformed(Plane(0.5 * side),
                                    Eigen::Affine3d(Eigen::Translation3d(40 + 10 * (i % 6), 10 * (i / 6), 0)))
                            .patches) {
      model_.patches.push_back(patch);
    }
  }
  job_.operation.floor_z = -10.0;
  job_.operation.detail = 1.0;
  EXPECT_THAT(Draw(), AllOf(HasSubstr("FLOOR: 1600.0 mm2"), HasSubstr("0 neutral, gentle"),
                            HasSubstr("and 7 more"), Not(HasSubstr("29 neutral, gentle"))));
}

TEST_F(RegionPicture, LeavesOutWhatIsNotSelected) {
  job_.operation.selection.patches = {"#1"};
  EXPECT_THAT(Draw(), AllOf(Not(HasSubstr("neutral, steep")), HasSubstr("neutral, gentle")));
}

TEST_F(RegionPicture, LeavesOutWhatIsSkipped) {
  RegionOverride change;
  change.at = Vec3(-40, 0, -24);
  change.skip = true;
  job_.operation.overrides = {change};
  EXPECT_THAT(Draw(), AllOf(HasSubstr("neutral, steep"), Not(HasSubstr("neutral, gentle"))));
}

// Every kind of move in the legend is drawn, in both views: a group of its colour that is not empty.
TEST_F(RegionPicture, ShowsEveryKindOfMove) {
  job_.operation.zigzag_angle = Radians(5);
  job_.operation.scallop = 0.05;
  const Surface surface = PlacedSurface(model_);
  const JobResult result = Mill(surface, job_);
  const auto resolved = Resolve(surface, job_, RunContext());
  ASSERT_TRUE(resolved.ok()) << resolved.status();
  const std::string picture = DrawJob(surface, result, *resolved, "roof");
  int kinds = 0;
  for (const MoveStyle& style : kMoveStyles) {
    if (picture.find(std::string(">") + style.name + "<") == std::string::npos) continue;
    ++kinds;
    const std::string group = std::string("<g fill=\"none\" stroke=\"") + style.color;
    int drawn = 0;
    for (std::size_t at = picture.find(group); at != std::string::npos; at = picture.find(group, at + 1)) {
      const std::size_t inside = picture.find('\n', at) + 1;
      drawn += picture.compare(inside, 9, "<polyline") == 0;
    }
    EXPECT_GE(drawn, 2) << style.name;
  }
  EXPECT_GE(kinds, 5);  // lines, contours, borders, links, rapids
}

}  // namespace
}  // namespace patchmill
