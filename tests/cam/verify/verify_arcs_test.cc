// Arcs of a program are judged as arcs: what lies between their ends counts.
#include <cmath>

#include <gmock/gmock.h>

#include "cam/verify/verify.h"
#include "tests/cam/verify/verify_models.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

constexpr double kRadius = 3.0, kBig = 10.0;  // of the ball and of the sphere

// Rings over a sphere as quarter circles. One ring, `other`, has arcs of `stretch` times its own radius
// between the same ends.
struct Rings {
  std::string program;
  int line = 0;  // of the first arc of the other ring
};
Rings OverSphere(int other, double stretch) {
  constexpr double kStep = 0.05;
  ProgramText text(20.0);
  Rings rings;
  text.Pass({{0, 0, kBig}, {0, 0, kBig + 1e-4}});
  for (int i = 1; i * kStep <= kPi / 2; ++i) {
    const double a = i * kStep, rho = (kBig + kRadius) * std::sin(a);
    text.Line(fmt::format("G0 X{:.6f} Y0", rho));
    text.Line(fmt::format("G1 Z{:.6f} F500", (kBig + kRadius) * std::cos(a) - kRadius));
    // Quarters: the arc over a chord of sqrt(2) rho.
    const double chord = std::sqrt(2.0) * rho, r = i == other ? stretch * rho : rho;
    for (int k = 0; k < 4; ++k) {
      const double turn = 0.5 * kPi * k;
      const Vec2 from = rho * Vec2(std::cos(turn), std::sin(turn)), to(-from.y(), from.x());
      const Vec2 center =
          0.5 * (from + to) - std::sqrt(r * r - 0.25 * chord * chord) * (from + to).normalized();
      const int line = text.Line(fmt::format("G3 X{:.6f} Y{:.6f} I{:.6f} J{:.6f}", to.x(), to.y(),
                                             center.x() - from.x(), center.y() - from.y()));
      if (i == other && k == 0) rings.line = line;
    }
    text.Line("G0 Z20");
  }
  rings.program = text.End();
  return rings;
}

VerifyReport Judge(const std::string& program) {
  VerifyParams params = Params(11.0);
  params.floor_z = -kRadius - 1.0;
  return Judged(SurfaceOf(Sphere(Vec3::Zero(), kBig, Half::kUpper)), Ball(kRadius), program, params);
}

TEST(VerifyArcs, ExactQuartersPassAndAreCounted) {
  const VerifyReport report = Judge(OverSphere(-1, 1.0).program);
  EXPECT_TRUE(report.ok()) << Findings(report);
  EXPECT_LE(report.max_gouge, 3e-4);
  EXPECT_EQ(report.arc_blocks, 4 * 31);
  // With each ring a plunge, and the first pass has its own two.
  EXPECT_EQ(report.feed_blocks, 4 * 31 + 31 + 2);
}

// A flatter arc between the right ends cuts into the sphere.
TEST(VerifyArcs, AnArcOutOfTheBudgetIsFound) {
  for (const double stretch : {1.005, 1.02, 1.1}) {
    const int ring = 20;
    const Rings rings = OverSphere(ring, stretch);
    const VerifyReport report = Judge(rings.program);
    const double a = ring * 0.05, rho = (kBig + kRadius) * std::sin(a), z = (kBig + kRadius) * std::cos(a);
    const double half = rho / std::sqrt(2.0), r = stretch * rho;
    // Nearest place of the arc to the axis: its middle.
    const double nearest = half + r - std::sqrt(r * r - half * half);
    const double truth = kRadius - (std::hypot(nearest, z) - kBig);
    ASSERT_GT(truth, 0.01);
    EXPECT_FALSE(report.gouge_ok) << stretch;
    EXPECT_NEAR(report.max_gouge, truth, 1.3e-3) << stretch;
    EXPECT_GE(report.max_gouge_at.line, rings.line);
    EXPECT_LE(report.max_gouge_at.line, rings.line + 3);
  }
}

// An arc onto a place of the surface whose ends and chord are free.
TEST(VerifyArcs, ALeadThatGougesByItsArcIsFound) {
  const double half = 10.0;
  const auto program = [&](const char* lead) {
    ProgramText text(20.0);
    for (int i = 0; i <= 66; ++i) {
      const double x = -half + 0.3 * i;
      text.Pass({{x, -half, 0}, {x, half, 0}});
    }
    text.Line("G0 X-4 Y0");
    text.Line("G1 Z0.2 F500");
    const int line = text.Line(lead);
    text.Line("G0 Z20");
    return Rings{text.End(), line};
  };
  const Surface surface = SurfaceOf(Plane(half));
  // In the plane of Z and X from (-4, 0.2) to (4, 0.2): over the top, or through the plane below.
  const Rings over = program("G18 G3 X4 Z0.2 I4 K-20 F500"), through = program("G18 G2 X4 Z0.2 I4 K20 F500");
  EXPECT_TRUE(Judged(surface, Ball(kRadius), over.program, Params(30.0)).gouge_ok);
  const VerifyReport report = Judged(surface, Ball(kRadius), through.program, Params(30.0));
  EXPECT_FALSE(report.gouge_ok);
  EXPECT_NEAR(report.max_gouge, std::hypot(4.0, 20.0) - 20.2, 1.3e-3);
  EXPECT_EQ(report.max_gouge_at.line, through.line);
}

}  // namespace
}  // namespace patchmill
