// [verification P1, P3] of whole programs: every kind of motion, rapids, starts, ends and descents.
#include <algorithm>
#include <chrono>
#include <cmath>

#include <gmock/gmock.h>

#include "cam/verify/motion_figures.h"
#include "tests/cam/verify/verify_models.h"
#include "tests/support/joined_surface.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

TEST(VerifyMotion, RapidInStock) {
  const double half = 10.0;
  const Surface surface = SurfaceOf(Plane(half));
  VerifyParams params = Params(0.5);
  ProgramText ok(5.0);
  ok.Line("G0 X-15 Y0");
  ok.Line("G0 Z1");
  ok.Line("G0 X8");  // above the stock
  ok.Line("G1 Z0 F100");
  ok.Line("G0 Z5");  // straight up out of the cut
  EXPECT_TRUE(Judged(surface, Ball(3.0), ok.End(), params).motion_ok);

  ProgramText bad(5.0);
  bad.Line("G0 X-15 Y0");
  bad.Line("G0 Z0.2");
  const int line = bad.Line("G0 X8");
  bad.Line("G0 Z5");
  const VerifyReport report = Judged(surface, Ball(3.0), bad.End(), params);
  EXPECT_FALSE(report.motion_ok);
  EXPECT_TRUE(report.gouge_ok);
  const Diagnostic* finding = Find(report, "RAPID_IN_STOCK");
  ASSERT_NE(finding, nullptr);
  EXPECT_EQ(finding->where.line, line);

  ProgramText plunge(5.0);
  plunge.Line("G0 X2 Y2");
  const int down = plunge.Line("G0 Z0.1");
  plunge.Line("G0 Z5");
  const VerifyReport second = Judged(surface, Ball(3.0), plunge.End(), params);
  EXPECT_FALSE(second.motion_ok);
  EXPECT_EQ(Find(second, "RAPID_IN_STOCK")->where.line, down);

  // A rapid may gouge as well.
  ProgramText deep(5.0);
  deep.Line("G0 X2 Y2");
  deep.Line("G0 Z-0.3");
  deep.Line("G0 Z5");
  EXPECT_NEAR(Judged(surface, Ball(3.0), deep.End(), params).max_gouge, 0.3, kCertainty);
}

// Low over the plan from (-20, 0), down to Z `z` and on by the rapid `to`: the finding with this code, which
// must be of that rapid.
bool FoundOnRapid(const Surface& surface, const VerifyParams& params, const char* to, double z,
                  const char* code) {
  ProgramText text(20.0);
  text.Line("G0 X-20 Y0");
  text.Line(fmt::format("G0 Z{}", z));
  const int line = text.Line(to);
  text.Line("G0 Z20");
  const VerifyReport report = Judged(surface, Ball(3.0), text.End(), params);
  EXPECT_EQ(Find(report, "RAPID_IN_STOCK"), nullptr);
  const Diagnostic* finding = Find(report, code);
  EXPECT_EQ(report.motion_ok, finding == nullptr);
  if (finding == nullptr) return false;
  EXPECT_EQ(finding->where.line, line);
  return true;
}

// Straight from (-20, 0) to (0, 20) a rapid passes 14.1 mm beside the dome's axis, clear of its 13.5; one
// axis before the other it would go over its top, or around it.
TEST(VerifyMotion, RapidsAreClearWhereverTheAxesGo) {
  const Surface surface = JoinedSurface(Sphere(Vec3(0, 0, 0), 10.0, Half::kUpper));
  VerifyParams params = Params(0.5);
  params.stock_top_z = 10.5;
  const auto judged = [&](const char* to, double z) {
    return FoundOnRapid(surface, params, to, z, "RAPID_DOG_LEG");
  };
  EXPECT_TRUE(judged("G0 X0 Y20", -3.0));
  EXPECT_TRUE(judged("G0 X0 Y20", 10.4));  // over the top, less than the stock above it
  EXPECT_FALSE(judged("G0 X0 Y20", 10.6));
  EXPECT_FALSE(judged("G0 X-20 Y20", -3.0));
  EXPECT_FALSE(judged("G0 X-14 Y20", -3.0));  // the rectangle keeps 14 mm off the axis
  EXPECT_TRUE(judged("G0 X-13 Y20", -3.0));
  // An avoided dome with 4 mm of margin: 17 mm off its axis.
  params.containment.avoided.assign(surface.network.model.patches.size(), true);
  params.containment.avoid_margin = 4.0;
  EXPECT_TRUE(FoundOnRapid(surface, params, "G0 X-14 Y20", -3.0, "AVOID_MARGIN"));
  EXPECT_TRUE(FoundOnRapid(surface, params, "G0 X-16.9 Y20", -3.0, "AVOID_MARGIN"));
  EXPECT_FALSE(FoundOnRapid(surface, params, "G0 X-17.1 Y20", -3.0, "AVOID_MARGIN"));
}

TEST(VerifyMotion, ObstaclesAreClearWhereverTheAxesGo) {
  const Surface surface = SurfaceOf(Plane(60.0));
  VerifyParams params = Params(0.5);
  params.containment.obstacles = {{"vice", Outline({{{-5, -5}, {5, -5}, {5, 5}, {-5, 5}}}), 8.0, 1.0}};
  const auto judged = [&](const char* to, double z) {
    return FoundOnRapid(surface, params, to, z, "OBSTACLE_HIT");
  };
  EXPECT_TRUE(judged("G0 X0 Y20", 2.0));
  EXPECT_TRUE(judged("G0 X0 Y20", 8.9));
  EXPECT_FALSE(judged("G0 X0 Y20", 9.0));
  EXPECT_FALSE(judged("G0 X-10 Y20", 2.0));  // 5 + 1 + 3 from the axis
  EXPECT_FALSE(judged("G0 X-9.001 Y20", 2.0));
  EXPECT_TRUE(judged("G0 X-8.9 Y20", 2.0));
  // Wide obstacles, over all of which the room is the same: too low by more than the tolerance or by less.
  params.containment.obstacles = {
      {"plate", Outline({{{-10, -60}, {60, -60}, {60, 60}, {-10, 60}}}), 8.0, 1.0}};
  EXPECT_TRUE(judged("G0 X40 Y40", 8.9));
  EXPECT_TRUE(judged("G0 X40 Y40", 1.0));
  EXPECT_FALSE(judged("G0 X40 Y40", 8.999));
  EXPECT_FALSE(judged("G0 X40 Y40", 9.0));
}

TEST(VerifyMotion, EndStateAndFirstMotion) {
  const Surface surface = SurfaceOf(Plane(5.0));
  const VerifyParams params = Params(1.0);
  const std::string head = "G21 G90\nG53 G0 Z0\nT1 M6\nS1000 M3\nM8\nG0 X0 Y0\nZ5\nG1 Z0 F100\nG0 Z5\n";
  EXPECT_TRUE(Judged(surface, Ball(3), head + kEnd, params).motion_ok);
  const VerifyReport open = Judged(surface, Ball(3), head, params);
  EXPECT_FALSE(open.motion_ok);
  EXPECT_NE(Find(open, "SPINDLE_LEFT_ON"), nullptr);
  EXPECT_NE(Find(open, "COOLANT_LEFT_ON"), nullptr);
  EXPECT_EQ(Find(open, "LAST_MOTION_NOT_UP"), nullptr);
  const VerifyReport low = Judged(surface, Ball(3), head + "G1 Z0\nM2\n", params);
  EXPECT_NE(Find(low, "LAST_MOTION_NOT_UP"), nullptr);
  const VerifyReport start = Judged(surface, Ball(3), std::string("G21 G90\nG0 X0 Y0\nZ5\n") + kEnd, params);
  EXPECT_NE(Find(start, "FIRST_MOTION_NOT_UP"), nullptr);
}

TEST(VerifyMotion, NoFeedIntoStockWithTheSpindleStopped) {
  const Surface surface = SurfaceOf(Plane(5.0));
  const std::string start = "G21 G90 G54 G61\nG53 G0 Z0\nT1 M6\nG43 H1\n",
                    cut = "G0 X0 Y0\nZ5\nG1 Z0 F100\nX4\nG0 Z5\n";
  Tool tool = Ball(3);
  tool.plunge_feed = 100;
  const VerifyReport turning = Judged(surface, tool, start + "S1000 M3\n" + cut + kEnd, Params(1.0));
  EXPECT_TRUE(turning.motion_ok);
  for (const Diagnostic& d : turning.findings) EXPECT_EQ(d.severity, Severity::kError) << d.message;
  const VerifyReport still = Judged(surface, Ball(3), start + cut + kEnd, Params(1.0));
  EXPECT_FALSE(still.motion_ok);
  ASSERT_NE(Find(still, "SPINDLE_STOPPED"), nullptr);
  EXPECT_EQ(*Find(still, "SPINDLE_STOPPED")->where.line, 7);
  const VerifyReport stopped =
      Judged(surface, Ball(3), start + "S1000 M3\n" + cut + "M5\nG1 Z4\nZ0\nG0 Z5\n" + kEnd, Params(1.0));
  ASSERT_NE(Find(stopped, "SPINDLE_STOPPED"), nullptr);
  EXPECT_EQ(*Find(stopped, "SPINDLE_STOPPED")->where.line, 13);
  // A tool change stops it, it needs a speed, and M4 turns it the wrong way.
  const std::string begin = "G21 G90 G61\nG53 G0 Z0\n";
  for (const char* on : {"S1000 M3\nT1 M6\nG43 H1\n", "T1 M6\nG43 H1\nM3\n", "T1 M6\nG43 H1\nS0 M3\n",
                         "T1 M6\nG43 H1\nS1000 M3\nS0\n"}) {
    const VerifyReport off = Judged(surface, Ball(3), begin + on + cut + kEnd, Params(1.0));
    EXPECT_NE(Find(off, "SPINDLE_STOPPED"), nullptr) << on;
    EXPECT_FALSE(off.motion_ok) << on;
  }
  const VerifyReport back = Judged(surface, Ball(3), start + "S1000 M4\n" + cut + kEnd, Params(1.0));
  EXPECT_TRUE(back.motion_ok);
  EXPECT_NE(Find(back, "SPINDLE_REVERSED"), nullptr);
  // High above the stock nothing is cut.
  EXPECT_TRUE(Judged(surface, Ball(3), start + "G0 X0 Y0\nZ50\nG1 X4 F100\n" + kEnd, Params(1.0)).motion_ok);
  // Settings that are left to the control are reported, and the verifier uses the assumed values.
  const VerifyReport open = Judged(surface, Ball(3), "G53 G0 Z0\nM3 S9\n" + cut + kEnd, Params(1.0));
  EXPECT_TRUE(open.motion_ok);
  EXPECT_NE(Find(open, "UNITS_ASSUMED"), nullptr);
  EXPECT_NE(Find(open, "LENGTH_OFFSET_ASSUMED"), nullptr);
}

TEST(VerifyMotion, SteepDescentsRunAtPlungeFeed) {
  const Surface surface = SurfaceOf(Plane(5.0));
  Tool tool = Ball(3.0);
  tool.plunge_feed = 100;
  const std::string head = "G21 G90\nG53 G0 Z0 S9 M3\nG0 X0 Y0\nZ5\n";
  EXPECT_TRUE(Judged(surface, tool, head + "G1 Z0 F100\nG1 X4 F900\n" + kEnd, Params(1.0)).motion_ok);
  const VerifyReport report = Judged(surface, tool, head + "G1 X1 Z0 F900\nX4\n" + kEnd, Params(1.0));
  EXPECT_FALSE(report.motion_ok);
  EXPECT_EQ(*Find(report, "STEEP_DESCENT")->where.line, 5);
  EXPECT_NEAR(report.steepest_descent, std::atan2(5.0, 1.0), 1e-12);
  EXPECT_EQ(Find(report, "PLUNGE_FEED_NOT_CHECKED"), nullptr);
  // Nobody says what it is.
  const VerifyReport unknown = Judged(surface, Ball(3.0), head + "G1 X1 Z0 F900\nX4\n" + kEnd, Params(1.0));
  EXPECT_TRUE(unknown.motion_ok);
  EXPECT_NE(Find(unknown, "PLUNGE_FEED_NOT_CHECKED"), nullptr);
}

// A gouge of 0.3 mm at X2 Y2, planted into each kind of motion that a program can have.
TEST(VerifyMotion, NoKindOfMotionMayGouge) {
  struct Case {
    const char* kind;
    std::vector<std::string> lines;
    std::size_t guilty;  // the line that is deepest first
  };
  const std::vector<Case> cases = {
      {"feed", {"G0 X-9 Y2 Z9", "G1 Z-0.3 X2 F100", "G0 Z9"}, 1},
      {"plunge", {"G0 X2 Y2", "G0 Z9", "G1 Z-0.3 F100", "G0 Z9"}, 2},
      {"rapid down", {"G0 X2 Y2", "G0 Z9", "G0 Z-0.3", "G0 Z9"}, 2},
      {"rapid aslant", {"G0 X-9 Y2", "G0 Z9", "G0 X2 Z-0.3", "G0 Z9"}, 2},
      {"rapid from machine zero", {"G0 X2 Y2", "G0 Z-0.3", "G0 Z9"}, 1},
      {"rapid from machine zero, aslant", {"G0 X-9 Y-9", "G0 X2 Y2 Z-0.3", "G0 Z9"}, 1},
      {"feed from machine zero", {"G0 X2 Y2", "G1 Z-0.3 F100", "G0 Z9"}, 1},
      {"incremental", {"G0 X2 Y2", "G0 Z9", "G91 G1 Z-9.3 F100", "G90 G0 Z9"}, 2},
      {"arc", {"G0 X0 Y2", "G0 Z9", "G1 Z0.5 F100", "G18 G2 X4 I2 K2.1", "G0 Z9"}, 3},
      {"arc of the other way", {"G0 X4 Y2", "G0 Z9", "G1 Z0.5 F100", "G18 G3 X0 I-2 K2.1", "G0 Z9"}, 3},
      {"arc in YZ", {"G0 X2 Y0", "G0 Z9", "G1 Z0.5 F100", "G19 G3 Y4 J2 K2.1", "G0 Z9"}, 3},
      {"helix", {"G0 X2 Y5", "G0 Z9", "G1 Z0.5 F100", "G17 G3 X2 Y2 Z-0.3 J-1.5", "G0 Z9"}, 3},
      {"inches", {"G0 X2 Y2", "G0 Z9", "G20 G1 Z-0.0118110236 F9", "G21 G0 Z9"}, 2},
  };
  const Surface surface = SurfaceOf(Plane(10.0));
  for (const Case& c : cases) {
    SCOPED_TRACE(c.kind);
    ProgramText text(20.0);
    text.Line("G0 X0 Y0");
    int guilty = 0;
    for (std::size_t i = 0; i < c.lines.size(); ++i) {
      const int line = text.Line(c.lines[i]);
      if (i == c.guilty) guilty = line;
    }
    const VerifyReport report = Judged(surface, Ball(3.0), text.End(), Params(0.5));
    EXPECT_FALSE(report.gouge_ok);
    EXPECT_NEAR(report.max_gouge, 0.3, kCertainty);
    EXPECT_NEAR(report.max_gouge_at.line, guilty, 1);  // the way up out of it is as deep
    if (std::string(c.kind) == "rapid from machine zero, aslant")
      continue;  // deep all along, for all we know
    EXPECT_NEAR(Xy(report.max_gouge_at.point).x(), 2.0, 0.2);
    EXPECT_NEAR(Xy(report.max_gouge_at.point).y(), 2.0, 0.2);
  }
}

TEST(VerifyMotion, WhereTheMachineStandsIsNotGuessed) {
  const Surface surface = SurfaceOf(Plane(10.0));
  const std::string head = "G21 G90\nG53 G0 Z0 S9 M3\n";
  const auto judged = [&](const std::string& lines) {
    return Judged(surface, Ball(3.0), head + lines + "G0 Z9\n" + kEnd, Params(0.5));
  };
  // Down on a slant from wherever the machine stood, or straight down there.
  for (const char* lines : {"G0 X4 Y4 Z0.2\n", "G1 X4 Y4 Z0 F100\n", "G0 Z0\nG0 X4 Y4\n", "G0 X4\nG0 Z0.2\n",
                            "G0 Y4\nG1 Z0.2 F100\nG1 X4\n", "G0 Z3\nG1 X4 Z0 F100\nY4\n"}) {
    const VerifyReport report = judged(lines);
    EXPECT_FALSE(report.motion_ok) << lines;
    EXPECT_NE(Find(report, "UNKNOWN_START"), nullptr) << lines << Findings(report);
  }
  // Above the stock it does not matter where it comes from.
  for (const char* lines : {"G0 X4 Y4 Z0.6\nG1 Z0 F100\n", "G0 Z0.6\nG0 X4 Y4\nG1 Z0 F100\n"}) {
    EXPECT_TRUE(judged(lines).motion_ok) << lines << Findings(judged(lines));
  }
}

TEST(VerifyMotion, TheLastMotionEndsOutOfTheStock) {
  const Surface surface = SurfaceOf(Plane(5.0));
  const std::string head = "G21 G90\nG53 G0 Z0 S9 M3\nG0 X0 Y0\nZ5\nG1 Z0 F100\n";
  const auto ends = [&](const std::string& last) {
    return Find(Judged(surface, Ball(3), head + last + "M2\n", Params(1.0)), "LAST_MOTION_NOT_UP") == nullptr;
  };
  EXPECT_FALSE(ends("G1 Z0.001\n"));
  EXPECT_FALSE(ends("G0 Z0.9\n"));
  EXPECT_TRUE(ends("G0 Z1\n"));
  EXPECT_FALSE(ends("G0 Z2\nX1\n"));
  EXPECT_TRUE(ends("G53 G0 Z0\n"));
}

TEST(VerifyMotion, DescentsCutIntoSmallStepsAreStillSteep) {
  const Surface surface = SurfaceOf(Plane(5.0));
  Tool tool = Ball(3.0);
  tool.plunge_feed = 100;
  // From Z1 down in steps of `dz`, each `dx` to the side, back and forth.
  const auto judged = [&](double dx, double dz, int feed) {
    std::string text = fmt::format("G21 G90\nG53 G0 Z0 S9 M3\nG0 X0 Y0\nZ1\nF{}\n", feed);
    for (int i = 1; i * dz <= 1.0; ++i) text += fmt::format("G1 X{:.4f} Z{:.4f}\n", i % 2 * dx, 1.0 - i * dz);
    return Judged(surface, tool, text + kEnd, Params(1.0));
  };
  for (const double dz : {0.0015, 0.005, 0.009}) {
    EXPECT_NE(Find(judged(0.0, dz, 900), "STEEP_DESCENT"), nullptr) << dz;
    EXPECT_NE(Find(judged(1.5 * dz, dz, 900), "STEEP_DESCENT"), nullptr) << dz;  // 33.7 degrees
    EXPECT_EQ(Find(judged(2.0 * dz, dz, 900), "STEEP_DESCENT"), nullptr) << dz;  // 26.6 degrees
    EXPECT_EQ(Find(judged(0.0, dz, 100), "STEEP_DESCENT"), nullptr) << dz;
  }
}

// Four decimals of an inch turn short moves by more than the slack for millimetres.
TEST(VerifyMotion, RoundingOfInchesIsNoSteepDescent) {
  const Surface surface = SurfaceOf(Plane(5.0));
  Tool tool = Ball(3.0);
  tool.plunge_feed = 100;
  const auto judged = [&](double angle_deg) {
    std::string text = "G20 G90\nG53 G0 Z0 S9 M3\nG0 X0 Y0\nZ0.04\nF35\n";
    const double step = 0.06 / 25.4, slope = std::tan(Radians(angle_deg));
    for (int i = 1; i * step * slope <= 0.0393; ++i)
      text += fmt::format("G1 X{:.4f} Z{:.4f}\n", i * step, 0.04 - i * step * slope);
    return Find(Judged(surface, tool, text + kEnd, Params(1.0)), "STEEP_DESCENT");
  };
  EXPECT_EQ(judged(29.9), nullptr);
  EXPECT_NE(judged(38.0), nullptr);
}

// Clear of the stock a descent may be as fast as any feed; where it meets the allowance it may not.
TEST(VerifyMotion, DescentsThroughAirMayBeFast) {
  const Surface surface = SurfaceOf(Plane(5.0));
  Tool tool = Ball(3.0);
  tool.plunge_feed = 100;
  const VerifyParams params = Params(1.0);
  const auto judged = [&](double z) {
    const std::string text =
        fmt::format("G21 G90\nG53 G0 Z0 S9 M3\nG0 X0 Y0\nZ6\nG1 Z{:.4f} F900\nG0 Z6\n", z);
    return Find(Judged(surface, tool, text + kEnd, params), "STEEP_DESCENT");
  };
  EXPECT_EQ(judged(params.allowance.walls + 0.001), nullptr);
  EXPECT_NE(judged(params.allowance.walls - 0.01), nullptr);
}

Machine SmallMachine() {
  Machine machine;
  for (MachineAxis& axis : machine.axes) axis = {-50.0, 50.0, 5000.0, 1000.0, 300.0};
  return machine;
}

// Each limit of the machine is found on its first line.
TEST(VerifyMotion, TheMachineMustReachAllPlaces) {
  const Surface surface = SurfaceOf(Plane(5.0));
  VerifyParams params = Params(1.0);
  params.machine = SmallMachine();
  const auto judged = [&](const std::string& moves) {
    const std::string text = "G21 G90\nG53 G0 Z0 S9 M3\nG0 X0 Y0\nZ6\n" + moves;
    return Judged(surface, Ball(3.0), text + kEnd, params);
  };
  EXPECT_EQ(Find(judged("G0 X60\nX-39\n"), "BEYOND_TRAVEL"), nullptr);  // its zero is not known
  const VerifyReport wide = judged("G0 X60\nX-41\nX-44\n");
  ASSERT_NE(Find(wide, "BEYOND_TRAVEL"), nullptr);
  EXPECT_EQ(*Find(wide, "BEYOND_TRAVEL")->where.line, 6);
  EXPECT_FALSE(wide.motion_ok);
  params.machine->work_zero = Vec3(-30, 0, 0);
  EXPECT_EQ(Find(judged("G0 X60\nX-19\n"), "BEYOND_TRAVEL"), nullptr);
  EXPECT_EQ(*Find(judged("G0 X60\nX-21\n"), "BEYOND_TRAVEL")->where.line, 6);
  EXPECT_EQ(*Find(judged("G0 Z51\n"), "BEYOND_TRAVEL")->where.line, 5);
  EXPECT_EQ(Find(judged("G1 X20 Y20 F1400\n"), "FEED_BEYOND_RANGE"), nullptr);  // 990 mm/min each
  EXPECT_EQ(*Find(judged("G1 X20 Y20 F1500\n"), "FEED_BEYOND_RANGE")->where.line, 5);
}

TEST(VerifyMotion, TheMachineMustReachTheSpeed) {
  const Surface surface = SurfaceOf(Plane(5.0));
  VerifyParams params = Params(1.0);
  params.machine = SmallMachine();
  params.machine->spindle_min = 100.0;
  params.machine->spindle_max = 24000.0;
  const auto judged = [&](const std::string& speed) {
    const std::string text = "G21 G90\nG53 G0 Z0 S" + speed + " M3\nG0 X0 Y0\nZ6\nG1 X5 F900\n";
    return Judged(surface, Ball(3.0), text + kEnd, params);
  };
  EXPECT_EQ(Find(judged("100"), "SPINDLE_BEYOND_RANGE"), nullptr);
  EXPECT_EQ(Find(judged("24000"), "SPINDLE_BEYOND_RANGE"), nullptr);
  for (const char* speed : {"99", "60000"}) {
    const VerifyReport report = judged(speed);
    ASSERT_NE(Find(report, "SPINDLE_BEYOND_RANGE"), nullptr) << speed;
    EXPECT_EQ(*Find(report, "SPINDLE_BEYOND_RANGE")->where.line, 5);
    EXPECT_FALSE(report.motion_ok);
  }
}

TEST(VerifyMotion, SmoothingOfRapidsCounts) {
  const Surface surface = SurfaceOf(Plane(10.0));
  VerifyParams params = Params(0.5);
  const auto judged = [&](double z, const std::string& mode) {
    ProgramText text(9.0);
    text.Line("G0 X-5 Y0");
    text.Line("G0 Z9");
    text.Line(mode);
    text.Line(fmt::format("G0 Z{:.3f}", z));
    text.Line("G0 X5");
    text.Line("G0 Z9");
    text.Line("G61");
    return Judged(surface, Ball(3.0), text.End(), params);
  };
  EXPECT_TRUE(judged(3.0, "G64 P2 Q0").gouge_ok);
  EXPECT_TRUE(judged(3.0, "G64 P2 Q0").motion_ok);
  const VerifyReport deep = judged(3.0, "G64 P4 Q0");
  EXPECT_FALSE(deep.gouge_ok);
  EXPECT_NE(Find(deep, "CONTROL_SMOOTHING"), nullptr);
  EXPECT_FALSE(judged(3.0, "G64").gouge_ok);
  // 0.4 mm above the surface, 0.5 mm of stock: in the stock by 0.1 mm, and smoothed by 0.2 mm more.
  params.stock_top_z = 4.0;
  EXPECT_NE(Find(judged(0.6, "G64 P0.2 Q0"), "RAPID_IN_STOCK"), nullptr);
  EXPECT_EQ(Find(judged(0.8, "G64 P0.2 Q0"), "RAPID_IN_STOCK"), nullptr);
}

// Gouges of a wider shank and rapids in stock are measured as exactly as gouges of the ball.
TEST(VerifyMotion, ShankAndStockAreKnownToTheCertainty) {
  const Surface surface = SurfaceOf(Block(5.0, 20.0, 30.0));
  Tool tool = Ball(3.0);
  tool.shank_diameter = 7.0;
  tool.flute_length = 8.0;
  const auto along_the_wall = [&](double inside) {  // the shank's axis is 3.5 - inside from the wall
    ProgramText text(30.0);
    text.Pass({{8.5 - inside, -4, 1}, {8.5 - inside, 4, 2}});
    return Judged(surface, tool, text.End(), Params(21.0));
  };
  EXPECT_TRUE(along_the_wall(0.0088).gouge_ok);
  const VerifyReport scrape = along_the_wall(0.0112);
  EXPECT_FALSE(scrape.gouge_ok);
  EXPECT_NEAR(scrape.max_gouge, 0.0112, kCertainty);
  EXPECT_NE(Find(scrape, "SHANK_GOUGE"), nullptr);

  const auto over_the_stock = [&](double inside) {
    ProgramText text(5.0);
    text.Line("G0 X-15 Y0");
    text.Line("G0 Z1");
    text.Line(fmt::format("G0 X8 Z{:.4f}", 0.5 - inside));
    text.Line("G0 Z5");
    return Judged(SurfaceOf(Plane(10.0)), Ball(3.0), text.End(), Params(0.9));
  };
  EXPECT_TRUE(over_the_stock(0.0).motion_ok);
  EXPECT_FALSE(over_the_stock(0.003).motion_ok);
}

// A rapid past a block whose ball has room however the axes are driven, and whose shank only straight.
TEST(VerifyMotion, ShankOfADogLeg) {
  const Surface surface = JoinedSurface(Block(5.0, 20.0, 30.0));
  Tool tool = Ball(3.0);
  tool.flute_length = 8.0;
  const auto judged = [&](double shank, const std::string& rapid, const VerifyParams& params) {
    tool.shank_diameter = 2.0 * shank;
    ProgramText text(40.0);
    text.Line("G0 X12 Y0");
    text.Line("G0 Z1");
    text.Line(rapid);
    text.Line("G0 Z40");
    return Judged(surface, tool, text.End(), params);
  };
  const std::string diagonal = "G0 X9 Y20";  // over X9 Y0, 4 mm from the wall
  VerifyParams params = Params(21.0);
  const VerifyReport hits = judged(4.02, diagonal, params);
  EXPECT_FALSE(hits.motion_ok);
  EXPECT_NE(Find(hits, "RAPID_DOG_LEG"), nullptr);
  EXPECT_EQ(Find(hits, "SHANK_GOUGE"), nullptr);
  EXPECT_TRUE(judged(4.005, diagonal, params).motion_ok);
  EXPECT_TRUE(
      judged(4.02, "G0 Y20\nG0 X9", params).motion_ok);  // one axis after the other, the right one first
  EXPECT_FALSE(judged(4.02, "G0 X9 Y20 Z14", params).motion_ok);  // begins as low
  // With a margin from the walls it is too near to them.
  params.containment.avoid_margin = 0.6;
  params.containment.avoided.assign(13, false);
  std::fill_n(params.containment.avoided.begin() + 8, 4, true);
  EXPECT_NE(Find(judged(3.42, diagonal, params), "AVOID_MARGIN"), nullptr);
  EXPECT_EQ(Find(judged(3.405, diagonal, params), "AVOID_MARGIN"), nullptr);
}

// The margin of avoided patches is the shank's too, from where it begins.
TEST(VerifyMotion, AvoidMarginOfAWiderShank) {
  const Surface surface = JoinedSurface(Block(5.0, 20.0, 30.0));
  Tool tool = Ball(3.0);
  tool.shank_diameter = 7.0;
  VerifyParams params = Params(21.0);
  params.containment.avoid_margin = 1.0;
  params.containment.avoided.assign(13, false);
  std::fill_n(params.containment.avoided.begin() + 8, 4, true);  // the walls
  const auto keeps_off = [&](double flute, double from_wall) {
    ProgramText text(40.0);
    text.Pass({{5.0 + from_wall, -4, 1}, {5.0 + from_wall, 4, 2}});
    tool.flute_length = flute;
    return Find(Judged(surface, tool, text.End(), params), "AVOID_MARGIN") == nullptr;
  };
  EXPECT_FALSE(keeps_off(8.0, 4.485));
  EXPECT_TRUE(keeps_off(8.0, 4.495));
  EXPECT_TRUE(keeps_off(20.1, 4.2));  // the shank begins 1.1 above the wall
  EXPECT_FALSE(keeps_off(18.5, 4.2));
  EXPECT_TRUE(keeps_off(8.0, 4.6));
  EXPECT_FALSE(keeps_off(20.1, 3.9));  // the ball
}

TEST(VerifyMotion, LongMovesOverABigPartCostLittle) {
  // A mesa in one corner keeps the answer open for all moves that go elsewhere.
  const Surface surface =
      SurfaceOf(Join({Plane(50.0), Single(Bilinear({48, 48, 9}, {50, 48, 9}, {48, 50, 9}, {50, 50, 9}))}));
  ProgramMotion motion;
  ProgramMove move;
  move.kind = ProgramMove::Kind::kFeed;
  for (int i = 0; i < 100'000; ++i) {
    move.from = move.to;
    move.to = i % 2 == 0 ? Vec3(-40, 30, 0) : Vec3(30, -40, 0);
    motion.moves.push_back(move);
  }
  const RunContext run(1);
  const auto start = std::chrono::steady_clock::now();
  const auto stickout = RequiredStickout(surface, Ball(3.0), motion, Params(10.0), run);
  ASSERT_TRUE(stickout.ok());
  EXPECT_NEAR(*stickout, 0.5, 1e-9);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(8));
  RunContext cancelled(1);
  cancelled.Cancel();
  EXPECT_EQ(RequiredStickout(surface, Ball(3.0), motion, Params(10.0), cancelled).status().code(),
            absl::StatusCode::kCancelled);
}

TEST(VerifyMotion, RequiredStickout) {
  ProgramText text(30.0);
  text.Pass({{9.0, -4, 1.0}, {9.0, 4, 1.0}});
  VerifyParams params = Params(21.0);
  const VerifyReport report = Judged(SurfaceOf(Block(5.0, 20.0, 30.0)), Ball(4.0), text.End(), params);
  EXPECT_NEAR(report.required_stickout, 20.5 - 1.0, 0.1);
}

}  // namespace
}  // namespace patchmill
