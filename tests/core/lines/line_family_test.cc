// Families: their levels, and that each one's field is the one it says.
#include "core/lines/line_family.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/lines/zero_curves.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

std::vector<ZeroCurve> Trace(const Surface& surface, const LineFamily& family, double level) {
  auto curves = TraceZeroCurves(surface, FieldOf(family, level), ZeroMeshParams(), 1e-4, RunContext());
  EXPECT_TRUE(curves.ok()) << curves.status();
  return *std::move(curves);
}

TEST(LineFamily, ContourLevelsAreRoundAndNotTooMany) {
  const Surface ball = SurfaceOf(Sphere(Vec3::Zero(), 10));
  EXPECT_EQ(ChooseLevels(ball, ContourLines{}, 3), (std::vector<double>{-5, 0, 5}));
  EXPECT_EQ(ChooseLevels(ball, ContourLines{}, 10), (std::vector<double>{-8, -6, -4, -2, 0, 2, 4, 6, 8}));
  const Surface surface = SurfaceOf(Sphere(Vec3(0, 0, 0.3), 10));  // z from -9.7 to 10.3
  for (const int count : {1, 2, 7, 19, 100}) {
    const std::vector<double> levels = ChooseLevels(surface, ContourLines{}, count);
    EXPECT_LE(levels.size(), static_cast<std::size_t>(count));
    EXPECT_GE(levels.size(), static_cast<std::size_t>(count) / 3);
    for (const double level : levels) {
      EXPECT_GT(level, -9.7);
      EXPECT_LT(level, 10.3);
    }
  }
  // Round as seen from the origin.
  for (const double level : ChooseLevels(surface, ContourLines{}, 4, Vec3(0, 0, 0.25))) {
    EXPECT_NEAR(std::remainder(level - 0.25, 5.0), 0.0, 1e-12);
  }
  EXPECT_TRUE(ChooseLevels(SurfaceOf(Plane(5, 2)), ContourLines{}, 9).empty());
}

TEST(LineFamily, OtherLevelsSpanTheirRange) {
  const Surface surface = SurfaceOf(Sphere(Vec3::Zero(), 10));
  const std::vector<double> slopes = ChooseLevels(surface, EquiSlopeLines{}, 8);
  ASSERT_EQ(slopes.size(), 8u);  // every 10 degrees
  for (std::size_t k = 0; k < 8; ++k)
    EXPECT_NEAR(Degrees(slopes[k]), 10.0 * (static_cast<double>(k) + 1), 1e-12);
  EXPECT_EQ(ChooseLevels(surface, BrightnessLines{}, 3), (std::vector<double>{-0.5, 0.0, 0.5}));
  EXPECT_EQ(ChooseLevels(surface, HighlightLines{}, 2), (std::vector<double>{0.0, kPi / 2}));
  for (const LineFamily& family : std::vector<LineFamily>{SilhouetteLines{}, EyeSilhouetteLines{},
                                                          ContourInflectionLines{}, SlopeExtremumLines{}}) {
    EXPECT_FALSE(HasLevels(family));
    EXPECT_TRUE(ChooseLevels(surface, family, 5).empty());
  }
}

// On a sphere about the origin every line is a circle in a known plane.
TEST(LineFamily, EachIsTheCircleItShouldBeOnASphere) {
  const double r = 10;
  const Surface surface = SurfaceOf(Sphere(Vec3::Zero(), r));
  const Vec3 d = Vec3(1, 2, 2) / 3.0;
  struct Case {
    LineFamily family;
    double level;
    Vec3 axis;
    std::vector<double> heights;  // along the axis
  };
  const Vec3 eye(0, 0, 25);
  const std::vector<Case> cases = {
      {ContourLines{d}, 4.0, d, {4.0}},
      {EquiSlopeLines{d}, Radians(60), d, {5.0, -5.0}},
      {BrightnessLines{d}, 0.3, d, {3.0}},
      {SilhouetteLines{d}, 0.0, d, {0.0}},
      {EyeSilhouetteLines{eye}, 0.0, Vec3::UnitZ(), {r * r / 25}},
      {HighlightLines{Vec3::UnitZ(), Vec3::UnitX()}, Radians(30), Vec3(-0.5, std::sqrt(0.75), 0), {0.0}},
  };
  for (const Case& c : cases) {
    const auto curves = Trace(surface, c.family, c.level);
    double length = 0.0, expected = 0.0;
    for (const double h : c.heights) expected += 2 * kPi * std::sqrt(r * r - h * h);
    for (const ZeroCurve& curve : curves) {
      const std::size_t n = curve.points.size();
      for (std::size_t i = 0; i < n; ++i) {
        const double h = c.axis.dot(curve.points[i].p);
        double off = kInfinity;
        for (const double wanted : c.heights) off = std::min(off, std::abs(h - wanted));
        EXPECT_LT(off, 1e-8) << c.family.index();
        if (i + 1 < n || curve.closed) length += (curve.points[(i + 1) % n].p - curve.points[i].p).norm();
      }
    }
    EXPECT_NEAR(length, expected, 1e-3 * expected) << c.family.index();
  }
}

}  // namespace
}  // namespace patchmill
