// Centres that are free come back as they were, with no defect; one that is not is raised to where it is,
// with the contact there, and counted.
#include "cam/path/chord/certify_centers.h"

#include <gtest/gtest.h>

#include "cam/path/contour/contour_paths.h"
#include "tests/cam/path/zlevel/level_checks.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using testing::Half;
using testing::MakeSurface;

constexpr double kGap = 1e-6;

TEST(CertifyCenters, LeavesFreeOnesAlone) {
  const Surface surface = MakeSurface(testing::Torus(Vec3::Zero(), 20.0, 6.0, Half::kUpper));
  const Locator locator(surface, 3.0);
  const LevelContours level = TraceLevel(locator, 5.0, {}, RunContext());
  ASSERT_EQ(level.loops.size(), 2u);
  for (const CutterPath& loop : level.loops) {
    CutterPath certified = loop;
    CertifyCenters(locator, kGap, certified);
    ASSERT_EQ(certified.points.size(), loop.points.size());
    for (std::size_t i = 0; i < loop.points.size(); ++i) {
      EXPECT_EQ(certified.points[i].center, loop.points[i].center);
      EXPECT_EQ(certified.points[i].contact.has_value(), loop.points[i].contact.has_value());
    }
  }
  EXPECT_EQ(locator.defect_count(), 0u);
}

TEST(CertifyCenters, RaisesWhatIsNotFree) {
  const double radius = 3.0, sphere = 10.0;
  const Surface surface = MakeSurface(testing::Sphere(Vec3::Zero(), sphere, Half::kUpper));
  const Locator locator(surface, radius);
  CutterPath path;
  const Vec2 q(2.0, 5.0);
  const double h = std::sqrt((sphere + radius) * (sphere + radius) - q.squaredNorm());
  for (const double off : {-0.5, -1e-5, 1e-5, 0.5}) path.points.push_back({Lift(q, h + off), {}, {}});
  CertifyCenters(locator, kGap, path);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_GE(path.points[i].center.z(), h - 1e-9);
    EXPECT_LE(path.points[i].center.z(), h + kGap + 1e-9);
    ASSERT_TRUE(path.points[i].contact);
    EXPECT_NEAR((path.points[i].contact->p - path.points[i].center).norm(), radius, kGap + 1e-9);
  }
  EXPECT_EQ(locator.defect_count(), 2u);
  EXPECT_EQ(path.points[2].center.z(), h + 1e-5);
  EXPECT_EQ(path.points[3].center.z(), h + 0.5);
}

}  // namespace
}  // namespace patchmill
