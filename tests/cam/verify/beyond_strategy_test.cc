// The area in which the verifier excuses forced passes. It contains the area that the planner leaves, and
// exceeds it by no more than the margin that both headers state.
#include "cam/verify/beyond_strategy.h"

#include <cmath>

#include <gtest/gtest.h>

#include "cam/path/reach/forced_steps.h"
#include "core/diffgeo/forms.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

constexpr double kRadius = 3.0, kFraction = 0.25, kMargin = 1.1;

struct Asked {
  ForcedSteps forced;
  LeftoverParams judged;
};

Asked Ask(bool contours, double angle, double scallop) {
  Asked asked;
  asked.forced.passes = contours ? ForcedPasses::kContours : ForcedPasses::kLines;
  asked.forced.angle = angle;
  asked.judged.reach.radius = kRadius;
  asked.judged.finish.scallop = scallop;
  asked.judged.finish.strategy = contours ? ForcedStrategy::kContour : ForcedStrategy::kZigzag;
  asked.judged.finish.zigzag_angle = angle;
  asked.judged.min_step_fraction = kFraction;
  return asked;
}

// Two implementations of the step: tight edges (a tenth of the ball) under scallops of up to a third of the
// ball, where the arc is far from a parabola, bowls and saddles.
TEST(BeyondStrategy, IsSurfaceThatNeedsLessThanTheNarrowestStep) {
  const std::vector<PatchModel> models = {
      Sphere(Vec3::Zero(), 0.3, Half::kUpper), Torus(Vec3::Zero(), 8.0, 0.5), Torus(Vec3::Zero(), 9.0, 3.5),
      Saddle(0.05, 0.03, 15.0), Cylinder(Vec3::Zero(), 5.0, 20.0, Half::kAll)};
  Random random(11);
  int beyond = 0, within = 0;
  for (const PatchModel& model : models) {
    const Surface surface = SurfaceOf(model);
    for (int i = 0; i < 4000; ++i) {
      const auto piece = static_cast<std::size_t>(random.Int(static_cast<int>(surface.pieces.size())));
      const SurfaceJet jet = Evaluate(surface.pieces[piece], random.Unit(), random.Unit());
      const auto facing = FacingAt(jet);
      if (!facing) continue;
      const Asked asked = Ask(i % 2 == 0, random.Uniform(0.0, kPi), kRadius * random.Uniform(1e-4, 0.33));
      const double step =
          NeededStepOfSides(asked.forced, jet, facing->e, {kRadius, *asked.judged.finish.scallop}) /
          kFraction;
      if (std::abs(step - kMargin) < 1e-4) continue;
      EXPECT_EQ(BeyondStrategy(jet, *facing, asked.judged), step < kMargin)
          << step << " at " << jet.p.transpose() << ", scallop " << *asked.judged.finish.scallop;
      ++(step < kMargin ? beyond : within);
    }
  }
  EXPECT_GT(beyond, 3000);
  EXPECT_GT(within, 3000);
}

// The inside of a torus' rim needs narrower lines than its outside: an upright place counts as its easier
// side, whichever way its normal happens to look.
TEST(BeyondStrategy, VerticalFaceCountsAsTheEasierOfItsSides) {
  const Surface surface = SurfaceOf(Torus(Vec3::Zero(), 2.0, 1.2));
  int upright = 0;
  for (const Piece& piece : surface.pieces) {
    const SurfaceJet jet = Evaluate(piece, 0.5, 0.0);  // on the outer equator or the inner one, or on top
    const auto normal = UnitNormal(jet);
    if (!normal || std::abs(normal->z()) > 1e-9 || Xy(jet.p).norm() < 3.0) continue;
    ++upright;
    const Vec3 e = normal->dot(jet.p) > 0.0 ? *normal : -*normal;
    // Lines that climb the rim here.
    const Asked asked = Ask(false, std::atan2(jet.p.y(), jet.p.x()), 0.02);
    const double outer = NeededStep(asked.forced, jet, e, {kRadius, 0.02});
    const double inner = NeededStep(asked.forced, jet, -e, {kRadius, 0.02});
    EXPECT_GT(outer, 1.0);
    EXPECT_LT(inner, kFraction * kMargin);
    EXPECT_EQ(NeededStepOfSides(asked.forced, jet, e, {kRadius, 0.02}), outer);
    EXPECT_EQ(NeededStepOfSides(asked.forced, jet, -e, {kRadius, 0.02}), outer);
    EXPECT_FALSE(BeyondStrategy(jet, {e, true}, asked.judged));
    EXPECT_FALSE(BeyondStrategy(jet, {-e, true}, asked.judged));
    EXPECT_TRUE(BeyondStrategy(jet, {-e, false}, asked.judged));
  }
  EXPECT_GE(upright, 4);
}

}  // namespace
}  // namespace patchmill
