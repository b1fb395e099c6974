// Walls have one side, and nothing is milled outside the part without mill_outside.
#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "cam/plan/beside_part.h"
#include "cam/plan/plan.h"
#include "cam/post/program_reader.h"
#include "cam/region/figures/reach_table.h"
#include "core/base/status.h"
#include "core/surface/air_sides.h"
#include "tests/support/jobs/limited_job.h"
#include "tests/support/profiles.h"
#include "tests/support/walls.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

constexpr double kBall = kLimitedRadius;
constexpr double kX = 20.0, kY = 15.0, kZ = 12.0;
// Of the open box: all of it, and what lies a ball radius or more from its lower and its upright edges.
constexpr double kAll = 4.0 * kX * kY + 4.0 * (kX + kY) * kZ;
constexpr double kReached = 4.0 * (kX - kBall) * (kY - kBall) + 4.0 * (kX + kY - 2.0 * kBall) * (kZ - kBall);
const double kCorner = (std::sqrt(3.0) - 1.0) * kBall;  // what stays where three planes meet

// The floor of a job is the model's lowest point.
Job BoxJob() {
  Job job = BallJob(kBall, false);
  job.operation.scallop = 0.05;
  job.operation.tolerance = 0.02;
  return job;
}

// The lowest tip of the program (ends of moves and places half a millimetre apart) where the axis is beyond
// the rectangle [-x,x] x [-y,y] by more than `beyond`; infinity if it never is.
double LowestTipBeyond(const std::string& program, double x, double y, double beyond) {
  const auto motion = ReadProgram(program, {});
  EXPECT_TRUE(motion.ok());
  double lowest = kInfinity;
  for (const ProgramMove& move : motion->moves) {
    const Vec3 way = move.to - move.from;
    const int parts = move.from_above || move.to_above ? 1 : 1 + static_cast<int>(way.norm() / 0.5);
    for (int k = 0; k <= parts; ++k) {
      if ((k == 0 && move.from_above) || (k == parts && move.to_above)) continue;
      const Vec3 tip = move.from + (double(k) / parts) * way;
      if (std::abs(tip.x()) > x + beyond || std::abs(tip.y()) > y + beyond)
        lowest = std::min(lowest, tip.z());
    }
  }
  return lowest;
}

bool Warns(const JobResult& result, const std::string& code) {
  return std::any_of(result.report.diagnostics.begin(), result.report.diagnostics.end(),
                     [&](const Diagnostic& d) { return d.code == code; });
}

// --- The open box: its walls look in ---

TEST(Sides, ABoxIsMilledInsideAlone) {
  for (const bool outside : {false, true}) {
    const Surface surface = PlacedSurface(OpenBox(kX, kY, kZ));
    Job job = BoxJob();
    job.operation.selection.mill_outside = outside;
    const JobResult result = Mill(surface, job);
    ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
    // The back of a wall is material, whatever the request says.
    EXPECT_GE(LowestTipBeyond(result.program, kX, kY, 0.0), kZ - 0.02);
    EXPECT_EQ(AreaFor(result, UnreachableReason::kOutside), 0.0);
    EXPECT_FALSE(Warns(result, "TOOL_BESIDE_PART"));
    EXPECT_NEAR(result.report.verify.reachable_area, kReached, 0.01 * kReached);
    EXPECT_NEAR(result.report.verify.unreachable_area[UncutReason::kConcave], kAll - kReached, 0.01 * kAll);
  }
}

// The tops of the walls moved by `out` (mm), as files round them.
PatchModel Leaning(PatchModel box, double out) {
  for (Patch& patch : box.patches) {
    for (Vec3& p : std::get<BezierPatch>(patch.shape).points) {
      if (p.z() < kZ) continue;
      p.x() += out * std::copysign(1.0, p.x());
      p.y() += out * std::copysign(1.0, p.y());
    }
  }
  return box;
}

TEST(Sides, AWallThatFilesRoundIsAWall) {
  for (const double out : {1e-4, -1e-4, 4e-3, -1e-3}) {
    SCOPED_TRACE(out);
    const JobResult result = Mill(PlacedSurface(Leaning(OpenBox(kX, kY, kZ), out)), BoxJob());
    ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
    EXPECT_GE(LowestTipBeyond(result.program, kX, kY, 0.01), kZ - 0.02);
    EXPECT_EQ(AreaFor(result, UnreachableReason::kOutside), 0.0);
    EXPECT_EQ(AreaFor(result, UnreachableReason::kUndercut), 0.0);
    EXPECT_NEAR(result.report.verify.reachable_area, kReached, 0.01 * kReached);
  }
}

// Walls that lean in are undercuts from inside. Their backs look up, but they are material.
TEST(Sides, AWallThatLeansInIsAnUndercut) {
  for (const double in : {0.02, 0.2, 0.5}) {
    SCOPED_TRACE(in);
    const JobResult result = Mill(PlacedSurface(Leaning(OpenBox(kX, kY, kZ), -in)), BoxJob());
    ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
    EXPECT_GE(LowestTipBeyond(result.program, kX - in, kY - in, 0.01), kZ - 0.02);
    // The reach tolerance lets the ball stand under the rim by half the tolerance, and finish so much of the
    // walls.
    const double rims = 4.0 * (kX + kY), walls = rims * kZ * std::min(1.0, 0.5 * 0.02 / in);
    const double floor = 4.0 * (kX - in - kBall) * (kY - in - kBall);
    EXPECT_GE(result.report.verify.reachable_area, floor);
    EXPECT_LE(result.report.verify.reachable_area, floor + 0.05 * rims + 1.2 * walls);
  }
}

// Splines through measured points wave. The walls are finished as upright ones are.
TEST(Sides, AWallThatWavesIsAWall) {
  for (const double shift : {1e-5, 1e-4, 4e-3, 0.012}) {
    SCOPED_TRACE(shift);
    const JobResult result = Mill(PlacedSurface(WavingBox(kX, kY, kZ, shift)), BoxJob());
    EXPECT_EQ(result.report.certificate_defects, 0U);
    // Contours follow the wall in long steps: at most two points per mm of cutting.
    EXPECT_LT(result.report.point_count, 2.0 * result.report.motion.cut_length);
    ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
    EXPECT_GE(LowestTipBeyond(result.program, kX, kY, 0.02), kZ - 0.02);
    EXPECT_NEAR(result.report.verify.reachable_area, kReached, 0.02 * kReached);
  }
}

TEST(Sides, TheRegionsOfABoxTellItsCorners) {
  const Surface surface = PlacedSurface(OpenBox(kX, kY, kZ));
  const auto regions = PlanRegions(surface, BoxJob(), RunContext());
  ASSERT_TRUE(regions.ok());
  double deepest = 0.0;
  for (const Region& r : regions->map.regions) deepest = std::max(deepest, r.deepest_leftover);
  EXPECT_NEAR(deepest, kCorner, 0.06 * kCorner);
}

TEST(Sides, WhatABallReachesOfABoxIsInside) {
  const Surface surface = PlacedSurface(OpenBox(kX, kY, kZ));
  const auto table = ReachTable(surface, {.radii = {kBall}, .tolerance = 0.02, .floor_z = 0.0}, RunContext());
  ASSERT_TRUE(table.ok());
  EXPECT_NEAR(table->unreachable[0], kAll - kReached, 0.01 * kAll);
}

// A program that mills the floor, and the walls from behind.
TEST(Sides, TheBackOfAWallFinishesNothing) {
  const PatchModel box = OpenBox(kX, kY, kZ);
  // The same walls around nothing but air are milled on both sides.
  const Surface tube = PlacedSurface(Walls(kX, kY, 0, kZ));
  Job job = BoxJob();
  job.operation.selection.mill_outside = true;
  const JobResult both = Mill(tube, job);
  ASSERT_FALSE(both.program.empty()) << Describe(both);
  // Without its feed moves inside the box.
  const auto all = ReadProgram(both.program, {});
  ASSERT_TRUE(all.ok());
  ProgramMotion motion = *all;
  std::erase_if(motion.moves, [](const ProgramMove& m) {
    const auto inside = [](const Vec3& p) { return std::abs(p.x()) < kX && std::abs(p.y()) < kY; };
    return m.kind == ProgramMove::Kind::kFeed && inside(m.from) && inside(m.to);
  });
  const Surface surface = PlacedSurface(box);
  const auto resolved = Resolve(surface, job, RunContext());
  ASSERT_TRUE(resolved.ok());
  const auto report =
      Verify(surface, job.operation.tool, motion, MakeVerifyParams(job, *resolved), RunContext());
  ASSERT_TRUE(report.ok());
  EXPECT_FALSE(report->finish_ok);
  EXPECT_GT(report->max_leftover, 1.0);
  EXPECT_GE(report->deepest_unreachable[UncutReason::kConcave], 0.97 * kCorner);
  EXPECT_TRUE(std::any_of(report->findings.begin(), report->findings.end(),
                          [](const Diagnostic& d) { return d.code == "BESIDE_PART"; }));
}

// --- Outside ---

// Not beside the ends of its wall either, where the part goes on.
TEST(Outside, ASheetWithOneWallIsMilledOnItsTop) {
  const auto at = [](double x, double y, double z) { return Vec3(x, y, z); };
  PatchModel sheet;
  sheet.patches.push_back(
      {"top", Bilinear(at(-kX, -kY, kZ), at(kX, -kY, kZ), at(-kX, kY, kZ), at(kX, kY, kZ))});
  sheet.patches.push_back(
      {"wall", Bilinear(at(-kX, -kY, 0), at(kX, -kY, 0), at(-kX, -kY, kZ), at(kX, -kY, kZ))});
  const JobResult result = Mill(PlacedSurface(sheet), BoxJob());
  ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
  EXPECT_GE(LowestTipBeyond(result.program, kX, kY, -1.0), kZ - 0.02);
  EXPECT_NEAR(AreaFor(result, UnreachableReason::kOutside), 2.0 * kX * kZ, 1e-3 * kX * kZ);
}

TEST(Outside, AClosedBlockIsMilledOnItsTop) {
  const Surface surface = PlacedSurface(ClosedBlock(kX, kY, kZ));
  const JobResult result = Mill(surface, BoxJob());
  ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
  EXPECT_GE(LowestTipBeyond(result.program, kX, kY, 0.0), kZ - 0.02);
  const double walls = 4.0 * (kX + kY) * kZ;
  EXPECT_NEAR(AreaFor(result, UnreachableReason::kOutside), walls, 0.01 * walls);
  EXPECT_NEAR(result.report.verify.unreachable_area[UncutReason::kOutside], walls, 0.01 * walls);
  EXPECT_NEAR(result.report.verify.reachable_area, 4.0 * kX * kY, 0.01 * 4.0 * kX * kY);
}

TEST(Outside, AClosedBlockIsMilledAroundWhereAsked) {
  const Surface surface = PlacedSurface(ClosedBlock(kX, kY, kZ));
  Job job = BoxJob();
  job.operation.selection.mill_outside = true;
  const JobResult result = Mill(surface, job);
  ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
  EXPECT_EQ(AreaFor(result, UnreachableReason::kOutside), 0.0);
  const double top_and_walls = 4.0 * kX * kY + 4.0 * (kX + kY) * kZ;
  // The floor keeps the ball from the walls' feet.
  EXPECT_NEAR(result.report.verify.reachable_area, top_and_walls - 4.0 * (kX + kY) * kBall,
              0.02 * top_and_walls);
  EXPECT_TRUE(Warns(result, "TOOL_BESIDE_PART"));
  EXPECT_NE(result.program.find("TOOL_BESIDE_PART"), std::string::npos);
}

TEST(Outside, WallsThatAreNamedAreMilled) {
  const Surface surface = PlacedSurface(ClosedBlock(kX, kY, kZ));
  Job job = BoxJob();
  job.operation.selection.patches = {"#2"};  // y = -15
  const JobResult result = Mill(surface, job);
  ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
  EXPECT_LT(LowestTipBeyond(result.program, kX + 2.0 * kBall, kY, 0.5 * kBall), 1.0);
  EXPECT_NEAR(result.report.verify.reachable_area, 2.0 * kX * (kZ - kBall), 0.03 * 2.0 * kX * kZ);
}

// A low block beside a high one: its top is finished up to where the high one's wall keeps the ball off.
TEST(Outside, AStepBesideAWallIsFinished) {
  const Surface surface = PlacedSurface(Join(
      {Level(-20, -10, 0, 10, 12), Wall({0, -10}, {0, 10}, 5, 12), Level(0, -10, 20, 10, 5),
       Wall({-20, -10}, {0, -10}, 0, 12), Wall({0, -10}, {20, -10}, 0, 5), Wall({20, -10}, {20, 10}, 0, 5),
       Wall({20, 10}, {0, 10}, 0, 5), Wall({0, 10}, {-20, 10}, 0, 12), Wall({-20, 10}, {-20, -10}, 0, 12)}));
  const JobResult result = Mill(surface, BoxJob());
  ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
  const double walls = 2.0 * 20 * 12 + 2.0 * 20 * 5 + 20.0 * 12 + 20.0 * 5;
  EXPECT_NEAR(AreaFor(result, UnreachableReason::kOutside), walls, 0.03 * walls);
  // Tops, and the wall between them, but for the edge that the ball does not get into.
  EXPECT_NEAR(result.report.verify.reachable_area, 800.0 + 20.0 * 7.0 - 2.0 * 20.0 * kBall, 0.03 * 800.0);
}

TEST(Outside, ABossOnAPlateKeepsItsFinish) {
  const Surface surface = PlacedSurface(Block(8, 10, 25));
  const JobResult plain = Mill(surface, BoxJob());
  Job job = BoxJob();
  job.operation.selection.mill_outside = true;
  EXPECT_EQ(AreaFor(plain, UnreachableReason::kOutside), 0.0);
  EXPECT_EQ(plain.program, Mill(surface, job).program);
}

// A core of half size `wide` at its top and `foot` at z = 0, with sides in so many rows of patches.
PatchModel DraftedCore(double wide, double foot, double high, int rows) {
  PatchModel model = Level(-wide, -wide, wide, wide, high);
  for (int row = 0; row < rows; ++row) {
    const auto corner = [&](int i, int level) {
      const double share = static_cast<double>(level) / rows, r = foot + share * (wide - foot);
      const double x[] = {-r, r, r, -r}, y[] = {-r, -r, r, r};
      return Vec3(x[i % 4], y[i % 4], share * high);
    };
    for (int k = 0; k < 4; ++k) {
      model = Join({std::move(model), Single(Bilinear(corner(k, row), corner(k + 1, row), corner(k, row + 1),
                                                      corner(k + 1, row + 1)))});
    }
  }
  return model;
}

// A drafted core leans. The tool goes down beside it, and a finding says so.
TEST(Outside, ADraftedCoreKeepsItsFinishAndSaysHowDeep) {
  const double draft = Radians(5.0), wide = 10.0, high = 10.0, foot = wide + high * std::tan(draft);
  const JobResult result = Mill(PlacedSurface(DraftedCore(wide, foot, high, 1)), BoxJob());
  ASSERT_FALSE(result.program.empty()) << Describe(result);
  EXPECT_EQ(AreaFor(result, UnreachableReason::kOutside), 0.0);
  EXPECT_TRUE(Warns(result, "TOOL_BESIDE_PART"));
  EXPECT_LT(LowestTipBeyond(result.program, foot, foot, 0.1), 0.1);
}

// Rows of patches that lean by less than the tolerance each are no upright wall.
TEST(Outside, ADraftedCoreOfManyRowsKeepsItsFinish) {
  const double wide = 10.0, high = 10.0, foot = wide + high * std::tan(Radians(0.25));
  for (const int rows : {1, 40}) {
    const JobResult result = Mill(PlacedSurface(DraftedCore(wide, foot, high, rows)), BoxJob());
    ASSERT_FALSE(result.program.empty()) << Describe(result);
    EXPECT_EQ(AreaFor(result, UnreachableReason::kOutside), 0.0) << rows;
    EXPECT_LT(LowestTipBeyond(result.program, foot, foot, 0.1), 0.1) << rows;
  }
}

TEST(Outside, ADomeKeepsItsFinish) {
  const Surface surface = PlacedSurface(Sphere({0, 0, 0}, 12, Half::kUpper));
  const JobResult result = Mill(surface, BoxJob());
  ASSERT_FALSE(result.program.empty()) << Describe(result);
  EXPECT_EQ(AreaFor(result, UnreachableReason::kOutside), 0.0);
  EXPECT_TRUE(Warns(result, "TOOL_BESIDE_PART"));
}

TEST(Outside, ASmallCylinderIsMilledOnItsTop) {
  const double radius = 15.0, high = 12.0;
  const JobResult result =
      Mill(PlacedSurface(Turned({Line({0, high}, {radius, high}), Line({radius, high}, {radius, 0}),
                                 Line({radius, 0}, {0, 0})})),
           BoxJob());
  ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
  EXPECT_GE(LowestTipBeyond(result.program, radius, radius, 0.0), high - 0.02);
  EXPECT_FALSE(Warns(result, "TOOL_BESIDE_PART"));
  const double wall = 2.0 * kPi * radius * high;
  EXPECT_NEAR(AreaFor(result, UnreachableReason::kOutside), wall, 0.03 * wall);
}

// Only walls are wanted, and they stand outside: the message says what lets them be milled.
TEST(Sides, NothingButWallsOutsideSaysWhatToDo) {
  Job job = BoxJob();
  job.operation.selection.avoid = {"#0"};  // the top
  const JobResult result = Mill(PlacedSurface(ClosedBlock(kX, kY, kZ)), job);
  ASSERT_EQ(result.report.outcome, Outcome::kNothingToCut) << Describe(result);
  const Diagnostic& last = result.report.diagnostics.back();
  EXPECT_EQ(last.code, "NOTHING_TO_CUT");
  EXPECT_NE(last.message.find("--outside"), std::string::npos) << last.message;
  EXPECT_NE(last.message.find("OUTSIDE"), std::string::npos) << last.message;
}

// A block that widens upwards is an undercut outside. The ball that rolls over its rim goes below the top, by
// about its radius.
TEST(Sides, TheToolBesideARimIsTold) {
  const JobResult result = Mill(PlacedSurface(Leaning(ClosedBlock(kX, kY, kZ), 0.6)), BoxJob());
  ASSERT_EQ(result.report.outcome, Outcome::kCompleteWhereReachable) << Describe(result);
  const double lowest = LowestTipBeyond(result.program, kX + 0.6, kY + 0.6, 0.1 * kBall);
  EXPECT_LT(lowest, kZ - 0.5 * kBall);
  EXPECT_GT(lowest, kZ - 1.2 * kBall);
  EXPECT_TRUE(Warns(result, "TOOL_BESIDE_PART"));
}

// A wall that stands alone is milled from the side that the user picks, and only from there.
TEST(WallSides, AWallAloneIsMilledFromThePickedSide) {
  const PatchModel model = Wall({0, 0}, {30, 0}, 0, 12);
  for (const double air : {-5.0, 5.0}) {
    SCOPED_TRACE(air);
    patchmill::Setup setup;
    setup.wall_sides = {{"#0", Vec3(10, air, 40)}};
    const auto surface = BuildPlacedSurface(model, setup, RunContext());
    ASSERT_TRUE(surface.ok()) << surface.status();
    EXPECT_TRUE(surface->two_sided_walls.empty());
    EXPECT_TRUE(WallsWithoutSide(*surface).empty());
    Job job = BoxJob();
    job.operation.selection.mill_outside = true;
    const JobResult result = Mill(*surface, job);
    ASSERT_FALSE(result.program.empty()) << Describe(result);
    int cuts = 0;
    for (const Move& move : result.motion.toolpath.moves) {
      if (move.kind != MoveKind::kCut || move.to.z() > 10.0) continue;
      EXPECT_GT(move.to.y() * air, 0.0);
      ++cuts;
    }
    EXPECT_GT(cuts, 5);
    EXPECT_NEAR(result.report.verify.reachable_area, 30.0 * (12.0 - kBall), 0.02 * 30.0 * 12.0);
  }
}

// One patch of three upright planes around 20 x 20 mm, open at y = 0. du x dv looks in.
PatchModel ThreeSides() {
  BsplinePatch wall{1, 1, {0, 0, 1, 2, 3, 3}, {0, 0, 1, 1}, {}, {}};
  for (const Vec2& corner : {Vec2(0, 0), Vec2(0, 20), Vec2(20, 20), Vec2(20, 0)}) {
    wall.points.push_back(Lift(corner, 0.0));
    wall.points.push_back(Lift(corner, 12.0));
  }
  return Single(std::move(wall));
}

// The point may be beside any plane of the wall.
TEST(WallSides, AWallOfSeveralPiecesHasOneSide) {
  for (const Vec2& in : {Vec2(2, 8), Vec2(9, 18), Vec2(18, 7)}) {
    const Vec2 across = in.x() == 2 ? Vec2(-4, 0) : in.x() == 18 ? Vec2(4, 0) : Vec2(0, 4);
    for (const int side : {1, -1}) {
      SCOPED_TRACE(in.x());
      SCOPED_TRACE(side);
      patchmill::Setup setup;
      setup.wall_sides = {{"#0", Lift(side > 0 ? in : Vec2(in + across), 5.0)}};
      const auto surface = BuildPlacedSurface(ThreeSides(), setup, RunContext());
      ASSERT_TRUE(surface.ok()) << surface.status();
      EXPECT_TRUE(surface->two_sided_walls.empty());
      ASSERT_GE(surface->pieces.size(), 3U);
      for (const Piece& piece : surface->pieces) EXPECT_EQ(piece.sides.air_side * OrientationOf(piece), side);
    }
  }
}

TEST(WallSides, FaultsAreNamed) {
  const auto refused = [](const PatchModel& model, const WallSide& side) {
    patchmill::Setup setup;
    setup.wall_sides = {side};
    const auto surface = BuildPlacedSurface(model, setup, RunContext());
    EXPECT_FALSE(surface.ok());
    return std::string(surface.status().message());
  };
  const PatchModel alone = Wall({0, 0}, {30, 0}, 0, 12);
  EXPECT_NE(refused(alone, {"#1", Vec3(1, 1, 1)}).find("setup.wall_sides[0].patch_id"), std::string::npos);
  EXPECT_NE(refused(alone, {"#0", Vec3(10, 0, 5)}).find("lies on the wall"), std::string::npos);
  EXPECT_NE(refused(OpenBox(kX, kY, kZ), {"#1", Vec3(0, 0, 5)}).find("is no upright wall with two sides"),
            std::string::npos);
}

}  // namespace
}  // namespace patchmill
