// Forced strategies finish the whole area in which their steps are not clamped, whatever the part, and
// report what they leave.
#include <gtest/gtest.h>

#include "tests/support/files.h"
#include "tests/support/jobs/jobs.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

struct ForcedCase {
  std::string name;
  std::function<PatchModel()> model;
  Setup setup;
  double radius = 3.0;
  double scallop = 0.02;
};

Setup Upright(double scale) {
  Setup setup;
  setup.placement.scale = scale;
  setup.placement.up = UpAxis::kY;
  return setup;
}

// Saddles, valleys, walls and a hill on a floor; real parts at a coarse finish.
const std::vector<ForcedCase>& Cases() {
  static const std::vector<ForcedCase> cases = {
      {"SteepV", [] { return TwoPlanes(Radians(30.0), 12.0); }, {}},
      {"ShallowV", [] { return TwoPlanes(Radians(10.0), 12.0); }, {}},
      {"Block", [] { return Block(6, 8, 14); }, {}, 2.0},
      {"Saddle", [] { return Saddle(0.05, 0.03, 15.0); }, {}},
      {"HemisphereOnPlane",
       [] {
         return Join({Sphere({0, 0, 0}, 10, Half::kUpper), Plane(20)});
       },
       {}},
      {"TwoHills", TwoHills, {}, 3.0, 0.1},
      {"Torus", [] { return LoadModel("tests/models/torus_bicubic.patches"); }, Upright(40.0), 3.0, 0.1},
      {"Teapot", [] { return LoadModel("examples/teapot.bpt"); }, Upright(50.0), 3.0, 0.05},
      // Beside silhouettes of its spout and handle lines are just wide enough on no more than a strip.
      {"LargerTeapot", [] { return LoadModel("examples/teapot.bpt"); }, Upright(54.8), 3.0, 0.03},
      {"Teacup", [] { return LoadModel("tests/models/teacup.bpt"); }, Upright(50.0), 3.0, 0.1},
  };
  return cases;
}

class ForcedStrategies : public ::testing::TestWithParam<std::tuple<std::size_t, Strategy>> {};

TEST_P(ForcedStrategies, FinishWhatTheyAreFor) {
  const auto& [index, strategy] = GetParam();
  const ForcedCase& given = Cases()[index];
  if (kSanitized && given.scallop > 0.04) GTEST_SKIP() << "too slow under sanitizers";
  Job job = BallJob(given.radius, /*deep=*/false);
  job.setup = given.setup;
  job.operation.scallop = given.scallop;
  job.operation.strategy = strategy;
  const Surface surface = PlacedSurface(given.model(), given.setup);
  const JobResult result = Mill(surface, job);
  Random random(1);
  CheckProgram(surface, job, result, random, 300);
  for (const CutterPath& path : result.motion.passes) {
    EXPECT_NE(path.kind, strategy == Strategy::kContour ? PassKind::kZigzag : PassKind::kContour);
  }
}

std::string CaseName(const ::testing::TestParamInfo<std::tuple<std::size_t, Strategy>>& info) {
  return Cases()[std::get<0>(info.param)].name +
         (std::get<1>(info.param) == Strategy::kContour ? "ByContours" : "ByLines");
}

INSTANTIATE_TEST_SUITE_P(Parts, ForcedStrategies,
                         ::testing::Combine(::testing::Range(std::size_t{0}, Cases().size()),
                                            ::testing::Values(Strategy::kContour, Strategy::kZigzag)),
                         CaseName);

// The step contours need on a plane is sin(slope) of the flat one, and they may not go below a quarter of
// it: a plane of 16 degrees is theirs (sin = 0.276), one of 8 degrees (0.139) is not: steps of a quarter
// leave 3.2 times the scallop there.
TEST(ForcedStrategies, ContoursAnswerForPlanesFromAQuarterOfTheStepOn) {
  Job job = BallJob(3.0);
  job.operation.scallop = 0.02;
  job.operation.strategy = Strategy::kContour;
  const Surface theirs = PlacedSurface(Plane(10.0, 0.0, std::tan(Radians(16.0))));
  const JobResult finished = Mill(theirs, job);
  EXPECT_TRUE(finished.report.verify.ok()) << Describe(finished);
  EXPECT_EQ(finished.report.verify.unreachable_area[UncutReason::kStrategy], 0.0) << Describe(finished);
  const Surface flat = PlacedSurface(Plane(10.0, 0.0, std::tan(Radians(8.0))));
  const JobResult excused = Mill(flat, job);
  EXPECT_TRUE(excused.report.verify.ok()) << Describe(excused);
  EXPECT_GT(excused.report.verify.unreachable_area[UncutReason::kStrategy], 20.0) << Describe(excused);
}

// Lines across an upright wall climb it at their full spacing: it is theirs to finish. A wall along the
// lines is not.
TEST(ForcedStrategies, LinesAnswerForWallsAcrossThem) {
  Job job = BallJob(2.0);
  job.operation.scallop = 0.02;
  job.operation.strategy = Strategy::kZigzag;
  const Surface surface = PlacedSurface(Block(6, 8, 14));
  for (const double angle : {0.0, Radians(90.0), Radians(35.0)}) {
    job.operation.zigzag_angle = angle;
    const JobResult result = Mill(surface, job);
    EXPECT_TRUE(result.report.verify.ok()) << Describe(result);
    // Two walls of 12 x 8 mm at most.
    EXPECT_LE(result.report.verify.unreachable_area[UncutReason::kStrategy],
              angle == Radians(35.0) ? 0.0 : 192.0)
        << Describe(result);
  }
}

}  // namespace
}  // namespace patchmill
