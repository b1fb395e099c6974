#include "core/lines/occurring_normals.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

// A part of a cylinder around y: normals from -10 to 10 degrees about y, tilted as a whole by `turn`.
OccurringNormals Fan(const Mat3& turn) {
  OccurringNormals normals;
  for (int k = -100; k <= 100; ++k) {
    const double angle = Radians(0.1 * k);
    normals.push_back({turn * Vec3(std::sin(angle), 0, std::cos(angle)), 1.0});
  }
  return normals;
}

TEST(OccurringNormals, HighlightsTurnAboutTheAxisOfACylinder) {
  for (const double tilt : {0.0, 0.4, 2.0}) {
    const Mat3 turn = Eigen::AngleAxisd(tilt, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    const OccurringNormals normals = Fan(turn);
    const HighlightLines family = ChooseHighlights(normals);
    EXPECT_NEAR(std::abs(family.plane.dot(turn * Vec3::UnitY())), 1.0, 1e-12);
    EXPECT_NEAR(std::abs(family.across.dot(turn * Vec3::UnitZ())), 1.0, 1e-12);
    // Ten levels over all but a hundredth of 20 degrees at either end, as angles from the middle.
    const std::vector<double> levels = LevelsOfNormals(normals, family, 10);
    ASSERT_EQ(levels.size(), 10U);
    for (std::size_t k = 0; k < 10; ++k) {
      const double from_middle = Degrees(std::remainder(levels[k], kPi));
      EXPECT_NEAR(std::abs(from_middle), std::abs(-9.8 + 19.6 * (static_cast<double>(k) + 0.5) / 10), 0.11);
      EXPECT_GE(levels[k], 0.0);
      EXPECT_LT(levels[k], kPi);
    }
  }
}

// The planes that a person chooses: levels run through half a turn and on from its beginning.
TEST(OccurringNormals, LevelsOfAGivenPlane) {
  const HighlightLines family{Vec3::UnitY(), Vec3::UnitX()};
  const std::vector<double> levels = LevelsOfNormals(Fan(Mat3::Identity()), family, 5);
  ASSERT_EQ(levels.size(), 5U);
  // About y, x turns to -z, so that the normals lie around 90 degrees.
  for (const double level : levels) EXPECT_NEAR(Degrees(level), 90.0, 8.0);
  EXPECT_NEAR(Degrees(levels[2]), 90.0, 0.11);
  const HighlightLines along{Vec3::UnitY(), Vec3::UnitZ()};
  const std::vector<double> around = LevelsOfNormals(Fan(Mat3::Identity()), along, 4);
  ASSERT_EQ(around.size(), 4U);
  EXPECT_GT(around[0], Radians(170));
  EXPECT_LT(around[3], Radians(10));
}

TEST(OccurringNormals, BrightnessChangesFromNormalToNormal) {
  const OccurringNormals normals = Fan(Mat3::Identity());
  const BrightnessLines family = ChooseBrightness(normals);
  EXPECT_NEAR(std::abs(family.light.y()), 0.0, 1e-12);
  EXPECT_NEAR(family.light.z(), std::sqrt(0.5), 1e-12);
  const std::vector<double> levels = LevelsOfNormals(normals, family, 6);
  ASSERT_EQ(levels.size(), 6U);
  EXPECT_TRUE(std::is_sorted(levels.begin(), levels.end()));
  EXPECT_GT(levels.front(), std::cos(Radians(55)));
  EXPECT_LT(levels.back(), std::cos(Radians(35)));
}

TEST(OccurringNormals, APlaneAndOtherFamiliesHaveNoLevels) {
  const OccurringNormals normals = NormalsOf(SurfaceOf(Plane(10)));
  ASSERT_FALSE(normals.empty());
  EXPECT_TRUE(LevelsOfNormals(normals, ChooseHighlights(normals), 9).empty());
  EXPECT_TRUE(LevelsOfNormals(normals, ChooseBrightness(normals), 9).empty());
  EXPECT_TRUE(LevelsOfNormals(normals, ContourLines(), 9).empty());
  EXPECT_TRUE(LevelsOfNormals({}, ChooseHighlights({}), 9).empty());
}

// Pieces and patches have the same normals, with the area of the surface in all.
TEST(OccurringNormals, OfASphere) {
  const PatchModel sphere = Sphere(Vec3(1, 2, 3), 5);
  for (const OccurringNormals& normals : {NormalsOf(SurfaceOf(sphere)), NormalsOf(sphere.patches)}) {
    double area = 0.0;
    for (const OccurringNormal& n : normals) area += n.area / 9.0;
    EXPECT_NEAR(area, 4 * kPi * 25, 0.05 * 4 * kPi * 25);
  }
}

}  // namespace
}  // namespace patchmill
