#include "cam/verify/verify.h"

#include <atomic>
#include <chrono>
#include <cmath>

#include <gmock/gmock.h>

#include "cam/limits/reach_tolerance.h"
#include "tests/cam/verify/verify_models.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

// Zig-zag over z = slope x (feed along y), ball centres on the offset plane, `step` apart on it.
struct PlanePasses {
  std::string program;
  std::vector<int> lines;  // of each pass' cut
};
PlanePasses OverPlane(double half, double slope, double r, double step, int skip = -1, double sink = 0.0) {
  ProgramText text(40.0);
  PlanePasses passes;
  const double c = 1.0 / std::hypot(1.0, slope), s = slope * c;
  const int n = static_cast<int>(std::ceil(2.0 * half / c / step));
  for (int i = 0; i <= n; ++i) {
    const double along = -half / c + i * step;  // arc length in the plane, from x = 0
    const Vec3 tip =
        Vec3(along * c, 0, along * s) + r * Vec3(-s, 0, c) - Vec3(0, 0, r + (i == n / 2 ? sink : 0.0));
    if (i == skip) {
      passes.lines.push_back(0);
      continue;
    }
    passes.lines.push_back(text.Pass({tip + Vec3(0, -half, 0), tip + Vec3(0, half, 0)})[0]);
  }
  passes.program = text.End();
  return passes;
}

TEST(Verify, PlaneLeftoverIsTheClosedForm) {
  for (const double slope : {0.0, 0.5, -2.0}) {
    const double r = 3.0, step = 0.6, half = 12.0;
    const Surface surface = SurfaceOf(Plane(half, 0.0, slope, 0.0));
    const VerifyReport report =
        Judged(surface, Ball(r), OverPlane(half, slope, r, step).program, Params(30.0));
    EXPECT_TRUE(report.gouge_ok && report.finish_ok && report.motion_ok) << Findings(report);
    const double truth = std::sqrt(r * r + step * step / 4) - r;
    EXPECT_LE(report.max_leftover, truth + 1e-5);
    EXPECT_GE(report.max_leftover, truth - kCertainty);
    EXPECT_LE(report.max_gouge, 1e-5);
    EXPECT_NEAR(report.total_area, 4 * half * half * std::hypot(1.0, slope), 1e-6);
    // The floor is not given, so all of a plane is reachable.
    EXPECT_NEAR(report.reachable_area, report.total_area, 1e-6);
    EXPECT_EQ(report.leftover_above_limit_area, 0.0);
  }
}

// Between two lines over a plane the leftover at distance x is sqrt(R^2 + x^2) - R.
TEST(Verify, TheSpreadOfLeftoverIsTheClosedForm) {
  const double r = 3.0, half = 12.0;
  for (const double step : {0.6, 0.3, 0.96}) {
    VerifyParams params = Params(30.0);
    params.tolerance = 0.03;
    const VerifyReport report =
        Judged(SurfaceOf(Plane(half)), Ball(r), OverPlane(half, 0.0, r, step).program, params);
    const double scallop = *params.finish.scallop, area = 4.0 * half * half;
    double below = 0.0, sum = 0.0;
    for (std::size_t k = 0; k < kLeftoverClasses; ++k) {
      sum += report.leftover_area[k];
      const double edge = k < kLeftoverEdges.size() ? kLeftoverEdges[k] * scallop : 1.0;
      const double share = std::min(1.0, std::sqrt(edge * (2.0 * r + edge)) / (0.5 * step));
      EXPECT_NEAR(report.leftover_area[k], (share - below) * area, 0.01 * area) << step << " class " << k;
      below = share;
    }
    EXPECT_NEAR(sum, report.reachable_area, 1e-6 * area);
  }
}

TEST(Verify, PlantedGougeIsFoundWithDepthPlaceAndLine) {
  const double r = 3.0, half = 12.0;
  for (const double sink : {0.012, 0.2}) {
    const PlanePasses passes = OverPlane(half, 0.0, r, 0.6, -1, sink);
    const VerifyReport report = Judged(SurfaceOf(Plane(half)), Ball(r), passes.program, Params(30.0));
    EXPECT_FALSE(report.gouge_ok);
    EXPECT_TRUE(report.motion_ok) << Findings(report);
    EXPECT_LE(report.max_gouge, sink + 1e-5);
    EXPECT_GE(report.max_gouge, sink - kCertainty);
    const int line = passes.lines[passes.lines.size() / 2];
    EXPECT_EQ(report.max_gouge_at.line, line);
    EXPECT_NEAR(report.max_gouge_at.point.x(), 0.0, 0.6);
    const Diagnostic* finding = Find(report, "GOUGE");
    ASSERT_NE(finding, nullptr);
    EXPECT_EQ(finding->where.line, line);
    EXPECT_EQ(finding->where.patch_index, 0);
  }
}

TEST(Verify, GougeJustWithinAndJustBeyondTheTolerance) {
  const double r = 3.0, half = 6.0;
  const Surface surface = SurfaceOf(Plane(half));
  VerifyParams params = Params(30.0);
  EXPECT_TRUE(Judged(surface, Ball(r), OverPlane(half, 0, r, 0.6, -1, 0.0088).program, params).gouge_ok);
  EXPECT_FALSE(Judged(surface, Ball(r), OverPlane(half, 0, r, 0.6, -1, 0.0112).program, params).gouge_ok);
}

TEST(Verify, TwoPlantedGougesAreBothListed) {
  const double r = 3.0, half = 12.0;
  ProgramText text(20.0);
  for (int i = 0; i <= 40; ++i) {
    const double x = -half + 0.6 * i;
    text.Pass({{x, -half, 0}, {x, half, 0}});
  }
  const int deep = text.Pass({{-6, -6, -0.5}, {-6, -5.9, -0.5}})[0];
  const int shallow = text.Pass({{7, 3, -0.03}, {7, 3.1, -0.03}})[0];
  const VerifyReport report = Judged(SurfaceOf(Plane(half)), Ball(r), text.End(), Params(5.0));
  std::vector<int> lines;
  for (const Diagnostic& d : report.findings) {
    if (d.code == "GOUGE") lines.push_back(*d.where.line);
  }
  // The plunge before each pass and the retract after it are as guilty as the pass.
  const auto near = [&](int line) {
    return std::any_of(lines.begin(), lines.end(), [&](int l) { return std::abs(l - line) <= 1; });
  };
  EXPECT_TRUE(near(deep) && near(shallow)) << Findings(report);
}

TEST(Verify, MissedStripIsLeftover) {
  const double r = 3.0, step = 0.6, half = 12.0;
  const PlanePasses passes = OverPlane(half, 0.0, r, step, 10);
  const VerifyReport report = Judged(SurfaceOf(Plane(half)), Ball(r), passes.program, Params(30.0));
  EXPECT_TRUE(report.gouge_ok);
  EXPECT_FALSE(report.finish_ok);
  const double truth = std::sqrt(r * r + step * step) - r;
  EXPECT_LE(report.max_leftover, truth + 1e-5);
  EXPECT_GE(report.max_leftover, truth - kCertainty);
  EXPECT_NEAR(report.max_leftover_at.point.x(), -half + 10 * step, 0.2);
  EXPECT_TRUE(report.max_leftover_at.line == passes.lines[9] ||
              report.max_leftover_at.line == passes.lines[11]);
  ASSERT_NE(Find(report, "LEFTOVER"), nullptr);
  // Where sqrt(r^2 + d^2) - r > scallop + tolerance, d from the next pass.
  const double d = std::sqrt(std::pow(r + 0.03, 2) - r * r);
  EXPECT_NEAR(report.leftover_above_limit_area, 2 * half * 2 * (step - d), 0.5);
}

// Between passes that are a little too far apart it is strips, much narrower than what areas are measured by.
TEST(Verify, NarrowRidgesCountByTheirWidth) {
  const double r = 3.0, half = 12.0, limit = 0.03;
  const double d = std::sqrt((r + limit) * (r + limit) - r * r);  // from a pass, where the limit is met
  for (const double slope : {0.0, 0.5}) {
    for (const double wide : {0.03, 0.06, 0.2}) {
      const double step = 2.0 * d + wide;
      const VerifyReport report = Judged(SurfaceOf(Plane(half, 0.0, slope, 0.0)), Ball(r),
                                         OverPlane(half, slope, r, step).program, Params(30.0));
      EXPECT_FALSE(report.finish_ok);
      const double all = 4 * half * half * std::hypot(1.0, slope), truth = all * wide / step;
      EXPECT_NEAR(report.leftover_above_limit_area, truth, 0.15 * truth + 1.0) << slope << " " << wide;
      EXPECT_NEAR(report.reachable_area, all, 1e-6);
    }
  }
}

TEST(Verify, SphereRingsLeaveTheClosedForm) {
  // Rings of the ball centre on the offset sphere, as arcs.
  const double r = 3.0, big = 10.0, delta = 0.05;
  ProgramText text(20.0);
  text.Pass({{0, 0, big}, {0, 0, big + 1e-4}});
  for (int i = 1; i * delta <= kPi / 2; ++i) {
    const double a = i * delta, rho = (big + r) * std::sin(a), z = (big + r) * std::cos(a) - r;
    text.Line(fmt::format("G0 X{:.6f} Y0", rho));
    text.Line(fmt::format("G1 Z{:.6f} F500", z));
    text.Line(fmt::format("G3 I{:.6f}", -rho));
    text.Line("G0 Z20");
  }
  const Surface surface = SurfaceOf(Sphere(Vec3::Zero(), big, Half::kUpper));
  VerifyParams params = Params(11.0);
  params.floor_z = -r - 1.0;
  const VerifyReport report = Judged(surface, Ball(r), text.End(), params);
  // Between the rings; the equator lies 0.021 rad below the last one.
  const double half = delta / 2;
  const double truth = std::sqrt(std::pow(big + r, 2) + big * big - 2 * big * (big + r) * std::cos(half)) - r;
  EXPECT_TRUE(report.gouge_ok && report.finish_ok && report.motion_ok) << Findings(report);
  EXPECT_LE(report.max_leftover, truth + 2e-4);
  EXPECT_GE(report.max_leftover, truth - kCertainty);
  EXPECT_LE(report.max_gouge, 2e-4);
  EXPECT_NEAR(report.total_area, 2 * kPi * big * big, 0.5);
}

TEST(Verify, UndersideIsUndercut) {
  const double r = 3.0, big = 10.0;
  ProgramText text(20.0);
  text.Pass({{0, 0, big}, {0.1, 0, big}});
  const VerifyReport report = Judged(SurfaceOf(Sphere(Vec3::Zero(), big)), Ball(r), text.End(), Params(11.0));
  const double half = 2 * kPi * big * big;
  // The reach tolerance g lets balls reach a little below the equator: R - g against the wall above it.
  EXPECT_NEAR(report.unreachable_area[UncutReason::kUndercut], half, 0.03 * half);
  EXPECT_NEAR(report.reachable_area, half, 0.03 * half);
  EXPECT_FALSE(report.finish_ok);
  EXPECT_GT(report.deepest_unreachable[UncutReason::kUndercut], 10.0);
  EXPECT_LT(report.deepest_unreachable_at[UncutReason::kUndercut].point.z(), 0.0);
}

TEST(Verify, ValleyOfTwoPlanesIsConcave) {
  const double r = 3.0, half = 10.0;
  for (const double a : {Radians(20.0), Radians(45.0)}) {
    ProgramText text(20.0);
    text.Pass({{0, -half, r / std::cos(a) - r}, {0, half, r / std::cos(a) - r}});
    VerifyParams params = Params(15.0);
    const VerifyReport report = Judged(SurfaceOf(TwoPlanes(a, half)), Ball(r), text.End(), params);
    // p at s from the crease: dist(p + R n1, plane 2) = s sin 2a + R cos 2a >= R - g.
    const double s = (r * (1 - std::cos(2 * a)) - ReachTolerance(params.tolerance)) / std::sin(2 * a);
    const double truth = 2 * s * 2 * half;
    EXPECT_NEAR(report.unreachable_area[UncutReason::kConcave], truth, 0.01 * truth);
    EXPECT_NEAR(report.deepest_unreachable[UncutReason::kConcave], r / std::cos(a) - r, 0.05);
    EXPECT_NEAR(report.deepest_unreachable_at[UncutReason::kConcave].point.x(), 0.0, 0.1);
    EXPECT_TRUE(report.gouge_ok) << Findings(report);
  }
}

TEST(Verify, FloorKeepsTheTipUp) {
  const double r = 3.0, half = 10.0;
  VerifyParams params = Params(30.0);
  params.floor_z = -half;  // the plane's lowest point; z = x
  const VerifyReport report =
      Judged(SurfaceOf(Plane(half, 0, 1.0, 0)), Ball(r), OverPlane(half, 1.0, r, 0.6).program, params);
  // A tip lies R (1 - cos 45) lower than its contact.
  const double strip = r * (1 - std::sqrt(0.5));
  EXPECT_NEAR(report.unreachable_area[UncutReason::kFloor], strip * std::sqrt(2.0) * 2 * half, 0.3);
  EXPECT_FALSE(report.motion_ok) << "these passes go below the floor";
  EXPECT_NE(Find(report, "BELOW_FLOOR"), nullptr);
  EXPECT_TRUE(report.finish_ok);
  // The lowest contact needs the tip that much lower; with that floor nothing is left for this reason.
  ASSERT_TRUE(report.finishing_floor_z);
  EXPECT_LE(*report.finishing_floor_z, -half - strip);
  EXPECT_GE(*report.finishing_floor_z, -half - strip - 0.0021);
  params.floor_z = *report.finishing_floor_z;
  const VerifyReport lower =
      Judged(SurfaceOf(Plane(half, 0, 1.0, 0)), Ball(r), OverPlane(half, 1.0, r, 0.6).program, params);
  EXPECT_EQ(lower.unreachable_area[UncutReason::kFloor], 0.0);
  EXPECT_FALSE(lower.finishing_floor_z);
}

// Where the lowest place lies within a patch, or the ball is larger by what is left.
TEST(Verify, TheFinishingFloorOfARoundBottom) {
  const double a = 0.02, turn = 0.3, leave = 0.25;
  const Surface surface =
      SurfaceOf(Transformed(Paraboloid(a, 10.0), Eigen::Affine3d(Eigen::AngleAxisd(turn, Vec3::UnitX()))));
  ProgramText text(40.0);
  text.Pass({{0, 0, 20}, {0.1, 0, 20}});
  VerifyParams params = Params(30.0);
  params.leave = leave;
  params.floor_z = 1.0;
  const VerifyReport report = Judged(surface, Ball(3.0), text.End(), params);
  ASSERT_TRUE(report.finishing_floor_z);
  // The lowest point of y sin t + a y^2 cos t, and what is left on it.
  const double truth = leave - std::sin(turn) * std::tan(turn) / (4 * a);
  EXPECT_LE(*report.finishing_floor_z, truth + 1e-6);
  EXPECT_GE(*report.finishing_floor_z, truth - 0.0011);
}

TEST(Verify, ManyFailuresAreListedInPart) {
  const double half = 40.0;
  ProgramText text(40.0);
  constexpr int kPasses = 23;  // with a ridge between each two
  const double apart = 2.0 * half / (kPasses - 1);
  for (int i = 0; i < kPasses; ++i) {
    const double x = -half + apart * i;
    text.Pass({{x, -half, 0}, {x, half, 0}});
  }
  const VerifyReport report = Judged(SurfaceOf(Plane(half)), Ball(3.0), text.End(), Params(30.0));
  const auto count = [&](const char* code) {
    return std::count_if(report.findings.begin(), report.findings.end(),
                         [&](const Diagnostic& d) { return d.code == code; });
  };
  EXPECT_FALSE(report.finish_ok);
  EXPECT_EQ(count("LEFTOVER"), 20);
  EXPECT_EQ(count("MORE_FINDINGS"), 1);
  EXPECT_NEAR(report.max_leftover, std::hypot(0.5 * apart, 3.0) - 3.0, kCertainty);
}

TEST(Verify, BothSidesOfAVerticalWallCount) {
  // The walls of a block face outwards; the inner side is never free.
  const Surface surface = SurfaceOf(Block(5.0, 8.0, 15.0));
  ProgramText text(20.0);
  text.Pass({{0, 0, 8}, {0.1, 0, 8}});
  const VerifyParams params = Params(9.0);
  const VerifyReport report = Judged(surface, Ball(2.0), text.End(), params);
  // The ball touches a wall down to R - g above the floor, and the floor from where it is R - g off the
  // wall on. The inner side of a wall is never free, but it is not the reason.
  const double r = 2.0 - ReachTolerance(params.tolerance);
  const double truth = 2 * 4 * 10.0 * r + kPi * r * r;
  EXPECT_NEAR(report.unreachable_area[UncutReason::kConcave], truth, 0.01 * truth);
  EXPECT_EQ(report.unreachable_area[UncutReason::kUndercut], 0.0);
  EXPECT_NEAR(report.total_area, 30.0 * 30.0 + 4 * 10.0 * 8.0, 1e-6);
}

TEST(Verify, ShankAboveTheBallScrapesAnOverhang) {
  const double half = 10.0;
  const Surface surface = SurfaceOf(
      Join({Plane(half), Single(Bilinear({4, -10, 12}, {10, -10, 12}, {4, 10, 12}, {10, 10, 12}))}));
  ProgramText text(30.0);
  const int line = text.Pass({{-8, 0, 0}, {8, 0, 0}})[0];
  const VerifyReport report = Judged(surface, Ball(3.0), text.End(), Params(15.0));
  EXPECT_FALSE(report.gouge_ok);
  EXPECT_NEAR(report.max_gouge, 3.0, kCertainty);
  EXPECT_GE(report.max_gouge_at.line, line);
  EXPECT_LE(report.max_gouge_at.line, line + 1);  // the retract through it as well
  EXPECT_EQ(report.max_gouge_at.patch_index, 1);
  EXPECT_NEAR(report.max_gouge_at.point.z(), 12.0, 1e-9);
}

TEST(Verify, WiderShankIsCheckedAgainstTheWall) {
  const Surface surface = SurfaceOf(Block(5.0, 20.0, 30.0));
  ProgramText text(30.0);
  const int line = text.Pass({{9.0, -4, 0}, {9.0, 4, 0}})[0];
  Tool tool = Ball(3.0);
  VerifyParams params = Params(21.0);
  EXPECT_TRUE(Judged(surface, tool, text.End(), params).gouge_ok);
  tool.shank_diameter = 10.0;
  tool.flute_length = 8.0;
  const VerifyReport report = Judged(surface, tool, text.End(), params);
  EXPECT_FALSE(report.gouge_ok);
  EXPECT_NEAR(report.max_gouge, 1.0, 0.02);  // the wall is 4 mm away
  const Diagnostic* finding = Find(report, "SHANK_GOUGE");
  ASSERT_NE(finding, nullptr);
  EXPECT_NEAR(*finding->where.line, line, 1);
  tool.flute_length = 20.5;
  EXPECT_TRUE(Judged(surface, tool, text.End(), params).gouge_ok);
  tool.flute_length.reset();
  EXPECT_FALSE(Verify(surface, tool, Motion(text.End()), params, RunContext(1)).ok());
}

TEST(Verify, ControlSmoothingCounts) {
  const double r = 3.0, half = 6.0;
  const Surface surface = SurfaceOf(Plane(half));
  std::string program = OverPlane(half, 0, r, 0.6, -1, 0.006).program;
  const auto with = [&](const std::string& word) {
    std::string text = program;
    return text.replace(text.find("G61"), 3, word);
  };
  EXPECT_TRUE(Judged(surface, Ball(r), with("G61"), Params(30.0)).gouge_ok);
  EXPECT_TRUE(Judged(surface, Ball(r), with("G64 P0.003 Q0"), Params(30.0)).gouge_ok);
  EXPECT_FALSE(Judged(surface, Ball(r), with("G64 P0.003"), Params(30.0)).gouge_ok);  // Q = P
  const VerifyReport bare = Judged(surface, Ball(r), with("G64"), Params(30.0));
  EXPECT_FALSE(bare.gouge_ok);
  EXPECT_NE(Find(bare, "CONTROL_SMOOTHING"), nullptr);
}

TEST(Verify, LeaveAndProgramZero) {
  const double r = 3.0, half = 8.0, leave = 0.3;
  const Vec3 zero(2, -1, 5);
  ProgramText text(20.0);
  for (int i = 0; i <= 27; ++i) {
    const Vec3 tip(-half + 0.6 * i, 0, leave);
    text.Pass({tip + Vec3(0, -half, 0) - zero, tip + Vec3(0, half, 0) - zero});
  }
  VerifyParams params = Params(1.0);
  params.program_zero = zero;
  params.leave = leave;
  const VerifyReport report = Judged(SurfaceOf(Plane(half)), Ball(r), text.End(), params);
  EXPECT_TRUE(report.ok()) << Findings(report);
  EXPECT_NEAR(report.max_leftover, std::hypot(r + leave, 0.3) - r - leave, kCertainty);
  EXPECT_NEAR(report.tip_z_min, leave - zero.z(), 1e-9);
  params.leave = 0.0;
  EXPECT_NEAR(Judged(SurfaceOf(Plane(half)), Ball(r), text.End(), params).max_leftover,
              std::hypot(r + leave, 0.3) - r, kCertainty);
}

TEST(Verify, ForcedContoursAreExcusedOnLevelSurface) {
  ProgramText text(20.0);
  text.Pass({{0, 0, 0}, {0.1, 0, 0}});
  VerifyParams params = Params(1.0);
  EXPECT_FALSE(Judged(SurfaceOf(Plane(8.0)), Ball(3.0), text.End(), params).finish_ok);
  params.finish.strategy = ForcedStrategy::kContour;
  const VerifyReport report = Judged(SurfaceOf(Plane(8.0)), Ball(3.0), text.End(), params);
  EXPECT_TRUE(report.finish_ok) << Findings(report);
  EXPECT_NEAR(report.unreachable_area[UncutReason::kStrategy], 256.0, 1.0);
  EXPECT_NEAR(report.unreachable_area[UncutReason::kStrategy] + report.reachable_area, 256.0, 1e-6);
  // Not on a wall of 60 degrees, where contours are at home.
  EXPECT_FALSE(Judged(SurfaceOf(Plane(8.0, 0, std::sqrt(3.0), 0)), Ball(3.0), text.End(), params).finish_ok);
  // Lines along y cannot finish a wall that falls along x at 85 degrees, lines along x can.
  params.finish.strategy = ForcedStrategy::kZigzag;
  params.finish.zigzag_angle = kPi / 2;
  const Surface wall = SurfaceOf(Plane(2.0, 0, std::tan(Radians(85.0)), 0));
  ProgramText above(60.0);
  above.Pass({{0, 0, 40}, {0.1, 0, 40}});
  params.stock_top_z = 30.0;
  EXPECT_TRUE(Judged(wall, Ball(3.0), above.End(), params).finish_ok);
  params.finish.zigzag_angle = 0.0;
  EXPECT_FALSE(Judged(wall, Ball(3.0), above.End(), params).finish_ok);
}

TEST(Verify, RefusesNonsense) {
  const Surface surface = SurfaceOf(Plane(5.0));
  const ProgramMotion motion = Motion("G21\nG53 G0 Z0\nG0 X0 Y0\nZ5\nM2\n");
  const RunContext run(1);
  EXPECT_FALSE(Verify(surface, Ball(0.0), motion, Params(1), run).ok());
  EXPECT_FALSE(Verify(surface, Ball(std::nan("")), motion, Params(1), run).ok());
  EXPECT_FALSE(Verify(surface, Ball(3.0), ProgramMotion{}, Params(1), run).ok());
  VerifyParams params = Params(1);
  params.finish.scallop = 3.5;
  EXPECT_FALSE(Verify(surface, Ball(3.0), motion, params, run).ok());
  params = Params(1);
  params.tolerance = 0.0;
  EXPECT_FALSE(Verify(surface, Ball(3.0), motion, params, run).ok());
}

TEST(Verify, NothingCutIsFullLeftover) {
  const VerifyReport report =
      Judged(SurfaceOf(Plane(5.0)), Ball(3.0), "G21\nG53 G0 Z0\nG0 X0 Y0\nZ5\nM2\n", Params(1));
  EXPECT_FALSE(report.finish_ok);
  EXPECT_TRUE(std::isfinite(report.max_leftover));
  EXPECT_NEAR(report.leftover_above_limit_area, 100.0, 1e-6);
}

TEST(Verify, CancelIsObeyed) {
  RunContext run(2);
  run.Cancel();
  const auto report = Verify(SurfaceOf(Bumpy()), Ball(3.0),
                             Motion("G21\nG53 G0 Z0\nG0 X0 Y0\nZ50\nG1 X1 F5\nM2\n"), Params(50), run);
  EXPECT_EQ(report.status().code(), absl::StatusCode::kCancelled);
}

// From any stage, at once: little work is left undone between two polls.
TEST(Verify, CancelInEveryStage) {
  const Surface surface = SurfaceOf(TwoHills());
  ProgramText text(60.0);
  for (int i = 0; i <= 100; i += 2) text.Pass({{0.0, 1.0 * i, 40}, {100.0, 1.0 * i, 40}});
  const ProgramMotion motion = Motion(text.End());
  for (const std::string stage : {"verify: gouge", "verify: reach", "verify: leftover"}) {
    RunContext run(2);
    std::atomic<bool> seen = false;
    std::chrono::steady_clock::time_point cancelled;
    run.set_progress([&](std::string_view name, double fraction) {
      if (name != stage || fraction > 0.5 || seen.exchange(true)) return;
      cancelled = std::chrono::steady_clock::now();
      run.Cancel();
    });
    const auto report = Verify(surface, Ball(3.0), motion, Params(50), run);
    const std::chrono::duration<double> latency = std::chrono::steady_clock::now() - cancelled;
    EXPECT_TRUE(seen) << stage;
    EXPECT_EQ(report.status().code(), absl::StatusCode::kCancelled) << stage;
    EXPECT_LT(latency.count(), 0.5) << stage;  // 0.2 s is promised; other tests run beside this one
  }
}

}  // namespace
}  // namespace patchmill
