// What a program tells the operator about its sections, and where it may be started again.
#include "cam/plan/program_sections.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cam/post/program_reader.h"
#include "tests/support/jobs/jobs.h"
#include "tests/support/profiles.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's
using ::testing::HasSubstr;

CutterPath Pass(PassKind kind, int region, double z) {
  CutterPath pass;
  pass.kind = kind;
  pass.region = RegionId{region};
  pass.points = {{{0, 0, z}, {}, {}}, {{1, 0, z}, {}, {}}};
  return pass;
}

// Passes of these kinds with a retract before each whose flag is set, 1200 mm long at 100 mm/min each.
struct Motion {
  LinkResult linked;

  void Add(const CutterPath& pass, bool retract) {
    std::vector<Move>& moves = linked.toolpath.moves;
    const int index = static_cast<int>(linked.passes.size());
    const Vec3 from(0, 0, pass.points.front().center.z());
    if (retract) {
      if (!moves.empty()) moves.push_back({.kind = MoveKind::kRapid, .to = {moves.back().to.x(), 0, 50}});
      moves.push_back({.kind = MoveKind::kRapid, .to = {0, 0, 50}});
      moves.push_back({.kind = MoveKind::kPlunge, .to = from, .feed = 100});
    } else {
      moves.push_back({.kind = MoveKind::kLink, .to = from, .feed = 1e5});
    }
    moves.push_back({.kind = MoveKind::kCut, .to = from + Vec3(1200, 0, 0), .feed = 100, .pass = index});
    linked.passes.push_back(pass);
  }
};

TEST(ProgramSections, BeginWhereRegionOrKindChanges) {
  RegionMap map;
  map.regions.resize(2);
  map.regions[0].slope = SlopeClass::kSteep;
  map.regions[1].slope = SlopeClass::kGentle;
  Motion motion;
  motion.linked.toolpath.ball_radius = 3.0;
  motion.Add(Pass(PassKind::kContour, 0, 20), true);
  motion.Add(Pass(PassKind::kContour, 0, 18), false);
  motion.Add(Pass(PassKind::kContour, 0, 16.5), true);  // 24 minutes later
  motion.Add(Pass(PassKind::kZigzag, 1, 12), false);
  motion.Add(Pass(PassKind::kRest, 1, 12), true);
  const auto sections = SectionsOf(motion.linked.toolpath, motion.linked, map, Vec3(0, 0, 10));
  ASSERT_EQ(sections.size(), 4u);
  EXPECT_EQ(sections[0].comment, "section 1, region 0, steep: 3 contours");
  ASSERT_TRUE(sections[0].tip);
  EXPECT_EQ(sections[0].tip->low, 3.5);
  EXPECT_EQ(sections[0].tip->high, 7.0);
  EXPECT_EQ(sections[0].first_move, 0u);
  EXPECT_FALSE(sections[0].restart);  // it is the start
  EXPECT_EQ(sections[1].comment, "section 1, continued");
  EXPECT_FALSE(sections[1].tip);
  EXPECT_TRUE(sections[1].restart);
  EXPECT_EQ(sections[2].comment, "section 2, region 1, gentle: 1 line");
  EXPECT_EQ(sections[2].tip->low, -1.0);
  EXPECT_FALSE(sections[2].restart);
  EXPECT_EQ(sections[3].comment, "section 3, region 1, gentle: 1 rest pass");
  EXPECT_TRUE(sections[3].restart);
  for (const ProgramSection& section : sections) {
    if (!section.restart) continue;
    const std::vector<Move>& moves = motion.linked.toolpath.moves;
    EXPECT_EQ(moves[section.first_move].to, Vec3(0, 0, 50));
    EXPECT_EQ(moves[section.first_move - 1].to, Vec3(1200, 0, 50));
  }
}

// Two plates far apart.
TEST(ProgramSections, AProgramWithRestartPointsIsVerified) {
  PatchModel model;
  for (const double x : {0.0, 80.0}) {
    BezierPatch plate;
    plate.degree_u = plate.degree_v = 1;
    plate.points = {{x, 0, 0}, {x, 20, 0}, {x + 20, 0, 0}, {x + 20, 20, 0}};
    model.patches.push_back({"", std::move(plate)});
  }
  const Surface surface = PlacedSurface(std::move(model));
  Job job = BallJob(3.0);
  job.operation.scallop = 0.05;
  const JobResult plain = MillChecked(surface, job);
  job.restart_points = true;
  const JobResult result = MillChecked(surface, job);
  EXPECT_THAT(plain.program, HasSubstr("(section 1, region "));
  EXPECT_THAT(plain.program, ::testing::Not(HasSubstr("restart point")));
  EXPECT_THAT(result.program, HasSubstr("(restart point 1: "));
  EXPECT_EQ(result.report.verify.cut_length, plain.report.verify.cut_length);
}

}  // namespace
}  // namespace patchmill
