// Where curves meet: places known in closed form, touches, doubled strokes, ends.
#include "core/crossing/find_crossings.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error_details.h"

namespace patchmill {
namespace {

DrawnCurve Line(const Vec3& a, const Vec3& b) { return {"", AsChain(BezierCurve{{a, b}})}; }
// (x, c x^2 + d, z) for x in [-w, w].
DrawnCurve Parabola(double w, double c, double d, double z = 0.0) {
  return {"", AsChain(BezierCurve{
                  {Vec3(-w, c * w * w + d, z), Vec3(0, d - c * w * w, z), Vec3(w, c * w * w + d, z)}})};
}
Crossings Found(const std::vector<DrawnCurve>& curves, double tolerance) {
  const auto found = FindCrossings(curves, tolerance, RunContext());
  EXPECT_TRUE(found.ok()) << found.status();
  return found.ok() ? *found : Crossings();
}
double XOf(const DrawnCurve& curve, double t) { return Evaluate(curve.chain, t).p.x(); }

TEST(FindCrossings, OfALineAndAParabolaAreExact) {
  const std::vector<DrawnCurve> curves = {Parabola(10, 0.1, 0), Line({-10, 2.5, 0}, {10, 2.5, 0})};
  const Crossings found = Found(curves, 1e-3);
  ASSERT_EQ(found.meetings.size(), 2u);
  EXPECT_TRUE(found.touches.empty());
  EXPECT_TRUE(found.doubled.empty());
  EXPECT_NEAR(XOf(curves[0], found.meetings[0].a.t), -5.0, 1e-9);
  EXPECT_NEAR(XOf(curves[1], found.meetings[1].b.t), 5.0, 1e-9);
}

TEST(FindCrossings, NeedTheToleranceInSpace) {
  // The second curve passes 0.02 above the first.
  const std::vector<DrawnCurve> curves = {Parabola(10, 0.1, 0), Line({-10, 2.5, 0.02}, {10, 2.5, 0.02})};
  EXPECT_TRUE(Found(curves, 0.01).meetings.empty());
  const Crossings found = Found(curves, 0.03);
  ASSERT_EQ(found.meetings.size(), 2u);
  EXPECT_NEAR(found.meetings[0].distance, 0.02, 1e-9);
}

TEST(FindCrossings, CurvesThatTouchDoNotMeet) {
  const Crossings found = Found({Parabola(10, 0.1, 0), Parabola(10, -0.1, 0)}, 1e-3);
  EXPECT_TRUE(found.meetings.empty());
  ASSERT_EQ(found.touches.size(), 1u);
  EXPECT_NEAR(found.touches[0].a.t, 0.5, 0.02);
  // They keep within the tolerance as long as 0.2 x^2 does: |x| <= 0.0707.
  EXPECT_LE(found.touches[0].length, 0.3);
}

TEST(FindCrossings, AnEndThatIsShortByLessThanTheToleranceMeets) {
  const std::vector<DrawnCurve> curves = {Line({0, -0.5, 0}, {0, -5, 0}), Line({-10, 0, 0}, {10, 0, 0})};
  EXPECT_TRUE(Found(curves, 0.4).meetings.empty());
  const Crossings found = Found(curves, 0.6);
  ASSERT_EQ(found.meetings.size(), 1u);
  EXPECT_DOUBLE_EQ(found.meetings[0].a.t, 0.0);
  EXPECT_NEAR(found.meetings[0].b.t, 0.5, 1e-9);
}

TEST(FindCrossings, AStrokeDrawnTwiceIsDoubled) {
  // The second is shorter, runs the other way, and 0.005 aside.
  const Crossings found = Found({Line({-10, 0, 0}, {10, 0, 0}), Line({8, 0.005, 0}, {-9, 0.005, 0})}, 0.01);
  ASSERT_EQ(found.doubled.size(), 1u);
  EXPECT_EQ(found.doubled[0].curve, 1);
  EXPECT_EQ(found.doubled[0].by, 0);
  EXPECT_TRUE(found.doubled[0].whole);
}

TEST(FindCrossings, AStretchDrawnTwiceEndsInMeetings) {
  // The second follows the first from x = -8 to 0 and then leaves it at 45 degrees.
  DrawnCurve bent{"", {1, {0.0, 0.5, 1.0}, {Vec3(-8, 0, 0), Vec3(0, 0, 0), Vec3(6, 6, 0)}}};
  const Crossings found = Found({Line({-10, 0, 0}, {10, 0, 0}), bent}, 0.01);
  ASSERT_EQ(found.doubled.size(), 1u);
  EXPECT_FALSE(found.doubled[0].whole);
  EXPECT_NEAR(found.doubled[0].from, 0.0, 1e-9);
  EXPECT_NEAR(found.doubled[0].to, 0.5, 0.01);
}

TEST(FindCrossings, ACurveMeetsItselfAtItsDoublePoint) {
  // x = t^3 - 3 t, y = t^2 has its double point at t = +- sqrt 3: (0, 3).
  const auto at = [](double t) { return Vec3(t * t * t - 3 * t, t * t, 0); };
  const auto d = [](double t) { return Vec3(3 * t * t - 3, 2 * t, 0); };
  const double w = 2.5;
  const DrawnCurve loop{"", AsChain(ToBezier(HermiteCurve{at(-w), 2 * w * d(-w), at(w), 2 * w * d(w)}))};
  const Crossings found = Found({loop}, 1e-3);
  ASSERT_EQ(found.meetings.size(), 1u);
  EXPECT_NEAR(found.meetings[0].a.t, (w - std::sqrt(3.0)) / (2 * w), 1e-8);
  EXPECT_NEAR(found.meetings[0].b.t, (w + std::sqrt(3.0)) / (2 * w), 1e-8);
}

TEST(FindCrossings, AToleranceThatIsTooSmallIsAnErrorOfItsField) {
  std::vector<DrawnCurve> curves;
  for (int k = 0; k < 1000; ++k) curves.push_back(Parabola(1000, 1, k));
  const auto found = FindCrossings(curves, 1e-9, RunContext());
  EXPECT_EQ(FieldOf(found.status()), "tolerance_mm");
}

TEST(FindCrossings, EndsWhenItIsCancelled) {
  RunContext run;
  run.Cancel();
  EXPECT_EQ(FindCrossings({Parabola(10, 0.1, 0)}, 1e-3, run).status().code(), absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace patchmill
