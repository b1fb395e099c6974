#include "cam/path/stepover/step_over.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "core/base/vec.h"
#include "tests/support/json.h"

namespace patchmill {
namespace {

// The crest between two balls on a circle of radius rho, constructed point by point: centres at +-alpha, the
// circles cut on the bisector. Independent of the formulas under test.
double CrestOnCircle(double rho, bool concave, double radius, double center_step) {
  const double ring = concave ? rho - radius : rho + radius;
  const double alpha = 0.5 * center_step / ring;
  const double along = ring * std::cos(alpha), aside = ring * std::sin(alpha);
  const double reach = std::sqrt(radius * radius - aside * aside);
  return concave ? rho - (along + reach) : (along - reach) - rho;
}

TEST(Spacing, StepOnAPlaneOfTheVector) {
  const testing::Json data = testing::LoadJson(PATCHMILL_SOURCE_DIR "/tests/vectors/toolpath_offset.json");
  const double radius = data["R"].Number(), scallop = data["tol"].Number();
  for (const testing::Json& at : data["points"].Items())
    EXPECT_NEAR(CenterStep(radius, scallop, 0.0), at["scallop_step_plane"].Number(), 1e-12);
}

TEST(Spacing, PlaneIsTheChordOfTheCircle) {
  EXPECT_DOUBLE_EQ(CenterStep(3.0, 0.01, 0.0), 2.0 * std::sqrt(2 * 3.0 * 0.01 - 1e-4));
  EXPECT_NEAR(ScallopOfStep(3.0, 2.0 * std::sqrt(2 * 3.0 * 0.01 - 1e-4), 0.0), 0.01, 1e-15);
}

TEST(Spacing, NothingWhereTheBallDoesNotFit) {
  EXPECT_EQ(CenterStep(3.0, 0.01, 1.0 / 3.0), 0.0);
  EXPECT_EQ(CenterStep(3.0, 0.01, 5.0), 0.0);
  EXPECT_LT(CenterStep(3.0, 0.01, (1.0 - 1e-9) / 3.0), 1e-4);
}

TEST(Spacing, SmoothAcrossFlat) {
  const double flat = CenterStep(3.0, 0.01, 0.0);
  for (double k = 1e-2; k > 1e-18; k *= 0.1) {
    // First order: w_c = flat (1 - kappa (R - s) / 2), the rest is of second order.
    const double slope = 0.5 * (3.0 - 0.01);
    EXPECT_NEAR(CenterStep(3.0, 0.01, k), flat * (1.0 - k * slope), 10 * flat * k * k + 1e-15) << k;
    EXPECT_NEAR(CenterStep(3.0, 0.01, -k), flat * (1.0 + k * slope), 10 * flat * k * k + 1e-15) << k;
  }
}

// [spacing (3)], r = 3, cusp 5 um: allowed step-over / flat step-over, and the cusp that the flat step-over
// leaves.
TEST(Spacing, TableOfPeers) {
  const double radius = 3.0, s = 0.005, flat = CenterStep(radius, s, 0.0);
  EXPECT_NEAR(flat, 0.3463, 5e-5);
  const std::tuple<double, double, double, double, double> rows[] = {
      {1.25, 0.745, 1.81, 2.239, 0.20}, {1.5, 0.774, 1.67, 1.733, 0.33}, {2, 0.816, 1.50, 1.415, 0.50},
      {3, 0.866, 1.34, 1.225, 0.67},    {5, 0.913, 1.20, 1.118, 0.80},   {10, 0.953, 1.10, 1.054, 0.90}};
  for (const auto& [ratio, convex, convex_cusp, concave, concave_cusp] : rows) {
    const double kappa = 1.0 / (ratio * radius);
    EXPECT_NEAR(CenterStep(radius, s, -kappa) / (1 + kappa * radius) / flat, convex, 6e-4) << ratio;
    EXPECT_NEAR(CenterStep(radius, s, kappa) / (1 - kappa * radius) / flat, concave, 6e-4) << ratio;
    EXPECT_NEAR(ScallopOfStep(radius, flat * (1 + kappa * radius), -kappa) / s, convex_cusp, 6e-3) << ratio;
    EXPECT_NEAR(ScallopOfStep(radius, flat * (1 - kappa * radius), kappa) / s, concave_cusp, 6e-3) << ratio;
  }
}

RC_GTEST_PROP(Spacing, LeavesExactlyTheScallopOnCircles, ()) {
  const double radius = *rc::gen::inRange(5, 100000) * 1e-3;
  const double s = radius * (*rc::gen::inRange(1, 3000) * 1e-4);
  const double ratio = *rc::gen::inRange(1, 100000) * 1e-3;
  const double convex_rho = radius * ratio;
  const double wide = CenterStep(radius, s, -1.0 / convex_rho);
  RC_ASSERT(std::abs(CrestOnCircle(convex_rho, false, radius, wide) - s) < 1e-9 * (radius + convex_rho));
  const double concave_rho = radius * (1.0 + ratio);
  const double step = CenterStep(radius, s, 1.0 / concave_rho);
  const double alpha = 0.5 * step / (concave_rho - radius);
  if (alpha < kPi * 0.99) {
    RC_ASSERT(std::abs(CrestOnCircle(concave_rho, true, radius, step) - s) < 1e-9 * (radius + concave_rho));
  }
}

RC_GTEST_PROP(Spacing, InverseIsInverse, ()) {
  const double radius = *rc::gen::inRange(100, 10000) * 1e-3;
  const double s = radius * (*rc::gen::inRange(1, 1000) * 1e-4);
  const double kappa = (*rc::gen::inRange(-5000, 900)) * 1e-3 / radius;
  const double step = CenterStep(radius, s, kappa);
  if (kappa > 0 && step > 0.99 * kPi * (1 - kappa * radius) / kappa) return;  // past half way round
  RC_ASSERT(std::abs(ScallopOfStep(radius, step, kappa) - s) < 1e-10 * radius);
}

RC_GTEST_PROP(Spacing, FallsWithCurvatureAndGrowsWithScallop, ()) {
  const double radius = *rc::gen::inRange(100, 10000) * 1e-3;
  const double s = radius * (*rc::gen::inRange(1, 1000) * 1e-4);
  const double kappa = (*rc::gen::inRange(-2000, 990)) * 1e-3 / radius;
  RC_ASSERT(CenterStep(radius, s, kappa) <= CenterStep(radius, s, kappa - 0.01 / radius) + 1e-12);
  RC_ASSERT(CenterStep(radius, s, kappa) <= CenterStep(radius, 1.1 * s, kappa) + 1e-12);
}

TEST(Spacing, BallsThatDoNotMeetLeaveEverything) {
  EXPECT_EQ(ScallopOfStep(3.0, 7.0, 0.0), kInfinity);
  EXPECT_EQ(ScallopOfStep(3.0, 0.0, 0.0), 0.0);
}

// What a gap as wide as that leaves, against the scallop: ScallopOfStep.
TEST(WideGap, LeavesLittleMore) {
  for (const double scallop : {0.001, 0.01, 0.1}) {
    for (const double chord : {0.0005, 0.005, 0.05}) {
      const double left =
          ScallopOfStep(3.0, WideGap(scallop, chord) * CenterStep(3.0, scallop, 0.0), 0.0) - scallop;
      EXPECT_GT(left, 0.0);
      EXPECT_LE(left, 0.036 * scallop);
      EXPECT_LE(left, 0.53 * chord);
      EXPECT_GE(left, std::min(0.034 * scallop, 0.49 * chord));
    }
  }
}

}  // namespace
}  // namespace patchmill
