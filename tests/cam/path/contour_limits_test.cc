// Levels at the limit of what can be decided: every shape has a closed form, and the contour has to be right
// to 1e-9 mm in plan, above the resolution in number, below it at least on the safe side.
#include <gtest/gtest.h>

#include "tests/cam/path/contour_checks.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using testing::LargestRadiusError;
using testing::Level;
using testing::SignedArea;

constexpr double kR = 3.0;

// Distance from the rectangle |x| <= a, |y| <= b (b = 0: a segment), outside.
double RectangleDistance(const Vec2& q, double a, double b) {
  return std::hypot(std::max(0.0, std::abs(q.x()) - a), std::max(0.0, std::abs(q.y()) - b));
}

// A level plate's open border runs along the grid of cells; levels at which the contour itself lies on a grid
// line, or a hair to either side of it.
TEST(ContourLimits, StraightBordersAlongTheGrid) {
  const double a = 10.0;
  const Level plate(testing::Plane(a));
  const double unit = plate.params.resolution / 8.0;
  // The grid starts at -a - R - 4 units - 0.38... units (level_cells.cc): all of that, and x = a + rho whole.
  const double origin = -a - kR - (4.0 + 0.3819660112501051) * unit;
  for (const double rho_near : {2.0, 0.5, 2.99}) {
    const double line = origin + std::ceil((a + rho_near - origin) / unit) * unit;
    for (const double off : {0.0, 1e-10, -1e-10, 1e-6, -1e-6}) {
      const double rho = line - a + off, c = std::sqrt(kR * kR - rho * rho);
      SCOPED_TRACE(::testing::Message() << "rho " << rho << " off " << off);
      const LevelContours level = plate.At(c);
      ASSERT_EQ(level.loops.size(), 1u);
      EXPECT_EQ(level.ambiguous_cells, 0);
      EXPECT_EQ(level.z, c);
      for (const CutterPoint& p : level.loops[0].points)
        EXPECT_NEAR(RectangleDistance(Plan(p.center), a, a), rho, 1e-9);
      EXPECT_NEAR(SignedArea(level.loops[0]), -(4.0 * a * a + 8.0 * a * rho + kPi * rho * rho),
                  0.005 * 100.0);
    }
  }
  EXPECT_TRUE(plate.At(kR).loops.empty());  // the level of the flat itself, where the ball only touches
  EXPECT_TRUE(plate.At(kR + 1e-7).loops.empty());
}

// A wall without thickness is a segment in plan, its contour a stadium.
TEST(ContourLimits, VerticalSheets) {
  const double a = 10.0, top = 8.0;
  for (const double turn : {0.0, 0.3, kPi / 4.0}) {
    SCOPED_TRACE(turn);
    Eigen::Affine3d motion = Eigen::Affine3d::Identity();
    motion.linear() = Eigen::AngleAxisd(turn, Vec3::UnitZ()).toRotationMatrix();
    const Level wall(testing::Transformed(
        testing::Single(testing::Bilinear({-a, 0, 0}, {a, 0, 0}, {-a, 0, top}, {a, 0, top})), motion));
    for (const double c : {-2.0, 0.0, 5.0, top, top + 1.5, top + 2.999}) {
      SCOPED_TRACE(c);
      const LevelContours level = wall.At(c);
      ASSERT_EQ(level.loops.size(), 1u);
      const double above = std::max(0.0, c - top), rho = std::sqrt(kR * kR - above * above);
      for (const CutterPoint& p : level.loops[0].points) {
        const Vec2 q = Eigen::Rotation2Dd(-turn) * Plan(p.center);
        EXPECT_NEAR(RectangleDistance(q, a, 0.0), rho, 1e-9);
      }
      EXPECT_NEAR(SignedArea(level.loops[0]), -(4.0 * a * rho + kPi * rho * rho), 0.005 * 60.0);
    }
    EXPECT_TRUE(wall.At(top + kR).loops.empty());
  }
}

// A level at the height of a flat under the ball moves up by so little that the dome on it keeps its circle.
TEST(ContourLimits, FlatsExactlyAtTheLevel) {
  const Level dome(
      testing::Join({testing::Sphere(Vec3::Zero(), 5.0, testing::Half::kUpper), testing::Plane(20.0)}));
  const LevelContours level = dome.At(kR);
  EXPECT_GE(level.z, kR);
  EXPECT_LE(level.z, kR + 0.005);
  ASSERT_EQ(level.loops.size(), 1u);
  EXPECT_LE(LargestRadiusError(level.loops[0], Vec2::Zero(), std::sqrt(64.0 - level.z * level.z)), 1e-9);
  EXPECT_LT(SignedArea(level.loops[0]), 0.0);
  // A hair below, all over the plate is forbidden: its own border.
  const LevelContours below = dome.At(kR - 1e-4);
  ASSERT_EQ(below.loops.size(), 1u);
  const double rho = std::sqrt(kR * kR - below.z * below.z);
  for (const CutterPoint& p : below.loops[0].points)
    EXPECT_NEAR(RectangleDistance(Plan(p.center), 20.0, 20.0), rho, 1e-7);
}

// The same sphere twice, and one inside the other that touches it at the peak: one circle each.
TEST(ContourLimits, CoincidentPeaks) {
  const PatchModel outer = testing::Sphere(Vec3::Zero(), 5.0);
  for (const PatchModel& other : {outer, testing::Sphere(Vec3(0, 0, 3), 2.0)}) {
    const Level both(testing::Join({outer, other}));
    for (const double c : {1.0, 5.0, 7.5, 7.99, 7.9998}) {
      SCOPED_TRACE(c);
      const LevelContours level = both.At(c);
      ASSERT_EQ(level.loops.size(), 1u);
      EXPECT_LE(LargestRadiusError(level.loops[0], Vec2::Zero(), std::sqrt(64.0 - c * c)), 1e-9);
    }
    EXPECT_TRUE(both.At(8.0).loops.empty());
  }
}

// Discs of radius rho about x = +-5 meet where rho = 5, at c = sqrt(39).
TEST(ContourLimits, NecksAtTheSaddle) {
  const Level spheres(testing::TwoSpheres(5.0, 10.0));
  const double saddle = std::sqrt(39.0);
  for (const double below : {0.1, 1e-2, 1e-3}) {
    SCOPED_TRACE(below);
    EXPECT_EQ(spheres.At(saddle - below).loops.size(), 1u);
  }
  // The channel between the discs is 2 (5 - rho) wide: above the resolution it is open.
  for (const double width : {0.11, 0.2, 0.5}) {
    SCOPED_TRACE(width);
    const double rho = 5.0 - 0.5 * width;
    EXPECT_EQ(spheres.At(std::sqrt(64.0 - rho * rho)).loops.size(), 2u);
  }
  for (const double off : {0.0, 1e-9, 1e-6}) {
    const std::size_t loops = spheres.At(saddle + off, spheres.params.resolution / 8.0).loops.size();
    EXPECT_TRUE(loops == 1u || loops == 2u) << loops;
  }
}

// The free eye of a torus whose hole is as wide as the tool, wherever it lies on the grid.
TEST(ContourLimits, HolesAsWideAsTheTool) {
  const double minor = 6.0, c = 4.0, reach = std::sqrt((minor + kR) * (minor + kR) - c * c);
  for (const double shift : {0.0, 0.0031, 0.0173, 0.0402, 0.0909}) {
    for (const double eye : {0.0501, 0.06, 0.3}) {
      SCOPED_TRACE(::testing::Message() << "eye " << eye << " shift " << shift);
      const Vec3 center(shift, 0.7 * shift, 0.0);
      const Level torus(testing::Torus(center, reach + eye, minor, testing::Half::kUpper));
      const LevelContours level = torus.At(c);
      ASSERT_EQ(level.loops.size(), 2u);
      for (const CutterPath& loop : level.loops) {
        const bool outer = SignedArea(loop) < 0.0;
        EXPECT_LE(LargestRadiusError(loop, Plan(center), outer ? eye + 2.0 * reach : eye), 1e-9);
      }
    }
    // No free place at all, by a nanometre: the outer circle alone.
    const Level closed(testing::Torus(Vec3(shift, 0.0, 0.0), reach - 1e-6, minor, testing::Half::kUpper));
    const LevelContours level = closed.At(c);
    ASSERT_EQ(level.loops.size(), 1u);
    EXPECT_LT(SignedArea(level.loops[0]), 0.0);
    // Free, but narrower than any cell: found or counted as material.
    const Level open(testing::Torus(Vec3(shift, 0.0, 0.0), reach + 1e-6, minor, testing::Half::kUpper));
    EXPECT_LE(open.At(c).loops.size(), 2u);
  }
}

}  // namespace
}  // namespace patchmill
