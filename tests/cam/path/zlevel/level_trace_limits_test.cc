// Levels at the limit of what can be decided: every shape has a closed form, and the contour has to be right
// to 1e-9 mm in plan, above the resolution in number, below it at least on the safe side.
#include <gtest/gtest.h>

#include "cam/path/contour/contour_findings.h"
#include "tests/cam/path/zlevel/level_checks.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using testing::LargestRadiusError;
using testing::SignedArea;
using testing::TracedModel;

constexpr double kR = 3.0;

// Distance from the rectangle |x| <= a, |y| <= b (b = 0: a segment), outside.
double RectangleDistance(const Vec2& q, double a, double b) {
  return std::hypot(std::max(0.0, std::abs(q.x()) - a), std::max(0.0, std::abs(q.y()) - b));
}

// A level plate's open border runs along the grid of cells; levels at which the contour itself lies on a
// grid line, or a hair to either side of it.
TEST(ContourLimits, StraightBordersAlongTheGrid) {
  const double a = 10.0;
  const TracedModel plate(testing::Plane(a));
  const double unit = plate.params.resolution / 8.0;
  // The grid starts at -a - R - 4 units - 0.38... units (level_cells.cc): all of that, and x = a + rho
  // whole.
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
        EXPECT_NEAR(RectangleDistance(Xy(p.center), a, a), rho, 1e-9);
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
    const TracedModel wall(testing::Transformed(
        testing::Single(testing::Bilinear({-a, 0, 0}, {a, 0, 0}, {-a, 0, top}, {a, 0, top})), motion));
    for (const double c : {-2.0, 0.0, 5.0, top, top + 1.5, top + 2.999}) {
      SCOPED_TRACE(c);
      const LevelContours level = wall.At(c);
      ASSERT_EQ(level.loops.size(), 1u);
      const double above = std::max(0.0, c - top), rho = std::sqrt(kR * kR - above * above);
      for (const CutterPoint& p : level.loops[0].points) {
        const Vec2 q = Eigen::Rotation2Dd(-turn) * Xy(p.center);
        EXPECT_NEAR(RectangleDistance(q, a, 0.0), rho, 1e-9);
      }
      EXPECT_NEAR(SignedArea(level.loops[0]), -(4.0 * a * rho + kPi * rho * rho), 0.005 * 60.0);
    }
    EXPECT_TRUE(wall.At(top + kR).loops.empty());
  }
}

// A level at the height of a flat under the ball moves up by so little that the dome on it keeps its circle.
TEST(ContourLimits, FlatsExactlyAtTheLevel) {
  const TracedModel dome(
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
    EXPECT_NEAR(RectangleDistance(Xy(p.center), 20.0, 20.0), rho, 1e-7);
}

// The same sphere twice, and one inside the other that touches it at the peak: one circle each.
TEST(ContourLimits, CoincidentPeaks) {
  const PatchModel outer = testing::Sphere(Vec3::Zero(), 5.0);
  for (const PatchModel& other : {outer, testing::Sphere(Vec3(0, 0, 3), 2.0)}) {
    const TracedModel both(testing::Join({outer, other}));
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
  const TracedModel spheres(testing::TwoSpheres(5.0, 10.0));
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
      const TracedModel torus(testing::Torus(center, reach + eye, minor, testing::Half::kUpper));
      const LevelContours level = torus.At(c);
      ASSERT_EQ(level.loops.size(), 2u);
      for (const CutterPath& loop : level.loops) {
        const bool outer = SignedArea(loop) < 0.0;
        EXPECT_LE(LargestRadiusError(loop, Xy(center), outer ? eye + 2.0 * reach : eye), 1e-9);
      }
    }
    // No free place at all, by a nanometre: the outer circle alone.
    const TracedModel closed(
        testing::Torus(Vec3(shift, 0.0, 0.0), reach - 1e-6, minor, testing::Half::kUpper));
    const LevelContours level = closed.At(c);
    ASSERT_EQ(level.loops.size(), 1u);
    EXPECT_LT(SignedArea(level.loops[0]), 0.0);
    // Free, but narrower than any cell: found or counted as material.
    const TracedModel open(testing::Torus(Vec3(shift, 0.0, 0.0), reach + 1e-6, minor, testing::Half::kUpper));
    EXPECT_LE(open.At(c).loops.size(), 2u);
  }
}

// Two upright sheets without thickness, `length` long, with `width` more than the tool between them.
PatchModel Gap(double width, double length) {
  const double x = kR + 0.5 * width, y = 0.5 * length;
  const auto sheet = [&](double at) {
    return testing::Single(testing::Bilinear({at, -y, 0}, {at, y, 0}, {at, -y, 8}, {at, y, 8}));
  };
  return testing::Join({sheet(-x), sheet(x)});
}

bool CountsAsMaterial(const LevelContours& level, const Vec2& q) {
  int winding = 0;
  for (const CutterPath& loop : level.loops) winding += testing::Winding(loop, q);
  return winding == -1;
}

// What is free by less than a cell, or not free by as little, is left standing: its cells are counted, the
// first is named, and the ball stays out.
TEST(ContourLimits, WhatCannotBeDecidedCountsAsMaterial) {
  for (const double width : {-1e-6, 0.0, 1e-6, 1e-3}) {
    SCOPED_TRACE(width);
    const TracedModel gap(Gap(width, 10.0));
    const double cell = gap.params.resolution / 8.0;
    const LevelContours level = gap.At(5.0, cell);
    EXPECT_EQ(level.cell, cell);
    EXPECT_GE(level.ambiguous_cells, 10.0 / cell);  // all along the gap
    EXPECT_NEAR(level.ambiguous_at.x(), 0.0, cell);
    EXPECT_LE(std::abs(level.ambiguous_at.y()), 5.0 + 0.1);
    EXPECT_EQ(level.ambiguous_at.z(), 5.0);
    ASSERT_EQ(level.loops.size(), 1u);
    for (const double y : {-4.9, 0.0, 3.3}) EXPECT_TRUE(CountsAsMaterial(level, {0.0, y}));
  }
  // As wide as the resolution, the gap is free: two loops, and nothing is left undecided.
  const TracedModel open(Gap(0.1, 10.0));
  const LevelContours level = open.At(5.0);
  EXPECT_EQ(level.loops.size(), 2u);
  EXPECT_EQ(level.ambiguous_cells, 0);
  EXPECT_FALSE(CountsAsMaterial(level, Vec2::Zero()));
  // The neck between two spheres at the height of the saddle.
  const TracedModel spheres(testing::TwoSpheres(5.0, 10.0));
  const double saddle = std::sqrt(39.0);
  for (const double off : {-1e-6, 0.0, 1e-6}) {
    const LevelContours neck = spheres.At(saddle + off, spheres.params.resolution / 8.0);
    EXPECT_GT(neck.ambiguous_cells, 0);
    EXPECT_LE(Xy(neck.ambiguous_at).norm(), 0.5);
    EXPECT_TRUE(CountsAsMaterial(neck, Vec2::Zero()));
  }
}

// Passes between `bottom` and the rims of the sheets.
absl::StatusOr<ContourResult> PassesOf(const TracedModel& part) {
  ContourParams params = part.params;
  params.pass.scallop = 0.1;
  return ContourPaths(part.locator, params, RunContext());
}

TEST(ContourLimits, FindingsTellWhatWasNotDecided) {
  const TracedModel gap(Gap(1e-6, 10.0));
  const auto result = PassesOf(gap);
  ASSERT_TRUE(result.ok()) << result.status();
  ASSERT_FALSE(result->paths.empty());
  ASSERT_EQ(result->findings.size(), 1u);  // for all levels
  const Diagnostic& finding = result->findings[0];
  EXPECT_EQ(finding.code, "CONTOUR_AMBIGUOUS");
  EXPECT_EQ(finding.severity, Severity::kInfo);
  EXPECT_NE(finding.message.find(" cells of up to 0.0125 mm"), std::string::npos) << finding.message;
  ASSERT_TRUE(finding.where.point.has_value());
  EXPECT_NEAR(finding.where.point->x(), 0.0, 0.0125);
  EXPECT_LE(std::abs(finding.where.point->y()), 5.1);
  const Locator smaller(gap.surface, kR - 1.001 * gap.params.pass.chord_tolerance);
  for (const CutterPath& path : result->paths) {
    for (std::size_t i = 0; i + 1 < path.points.size(); ++i) {
      const Vec3 &a = path.points[i].center, &b = path.points[i + 1].center;
      for (const double t : {0.0, 0.25, 0.5, 0.75}) EXPECT_TRUE(smaller.Free(a + t * (b - a), 1e-9));
      EXPECT_FALSE(a.z() < 8.0 && std::abs(a.x()) < 1.0 && std::abs(a.y()) < 4.9) << a.transpose();
    }
  }
  const auto open = PassesOf(TracedModel(Gap(0.2, 10.0)));
  ASSERT_TRUE(open.ok());
  EXPECT_TRUE(open->findings.empty()) << open->findings[0].message;
}

// A gap so long that its undecided cells are too many: cells of twice the side, and that is said.
TEST(ContourLimits, ALostResolutionIsSaid) {
  const TracedModel gap(Gap(1e-6, 80.0));
  const LevelContours level = gap.At(5.0, gap.params.resolution / 4.0);
  EXPECT_EQ(level.cell, gap.params.resolution / 4.0);
  EXPECT_GT(level.ambiguous_cells, 80.0 / level.cell);
  EXPECT_NEAR(level.z, 5.0, 3.001e-3);
  EXPECT_EQ(level.loops.size(), 1u);
  EXPECT_TRUE(CountsAsMaterial(level, Vec2::Zero()));
  const auto result = PassesOf(gap);
  ASSERT_TRUE(result.ok()) << result.status();
  ASSERT_EQ(result->findings.size(), 2u);
  const Diagnostic &coarse = result->findings[0], &ambiguous = result->findings[1];
  EXPECT_EQ(coarse.code, "CONTOUR_COARSE");
  EXPECT_EQ(coarse.severity, Severity::kWarning);
  EXPECT_NE(coarse.message.find("0.1 mm takes too many cells, 0.2 mm is held"), std::string::npos)
      << coarse.message;
  ASSERT_TRUE(coarse.where.point.has_value());
  EXPECT_NEAR(coarse.where.point->x(), 0.0, 0.025);
  EXPECT_EQ(ambiguous.code, "CONTOUR_AMBIGUOUS");
  EXPECT_NE(ambiguous.message.find(" cells of up to 0.0250 mm"), std::string::npos) << ambiguous.message;
}

// One finding reports the worst of all levels with its place, whatever the order of the levels.
TEST(ContourLimits, FindingsAreOneForAllLevels) {
  const auto level = [](double z, double cell, int ambiguous, const Vec3& at) {
    return LevelContours{z, {}, cell, ambiguous, at};
  };
  const LevelContours fine = level(5.0, 0.0125, 0, Vec3::Zero());
  const LevelContours few = level(4.0, 0.0125, 3, Vec3(1.0, 0.0, 0.0));
  const LevelContours coarse = level(3.0, 0.05, 40, Vec3(2.0, 0.0, 0.0));
  const LevelContours twice = level(7.0, 0.025, 500, Vec3(3.0, 0.0, 0.0));
  ContourFindings none(0.1), one(0.1), all(0.1), back(0.1);
  none.Take(fine);
  EXPECT_TRUE(none.Findings().empty());
  one.Take(few);
  ASSERT_EQ(one.Findings().size(), 1u);
  EXPECT_EQ(one.Findings()[0].message.find("contour at centre height 4.0000 mm: 3 cells"), 0u)
      << one.Findings()[0].message;
  for (const LevelContours& l : {fine, few, coarse, twice}) all.Take(l);
  for (const LevelContours& l : {twice, coarse, few, fine}) back.Take(l);
  const Diagnostics findings = all.Findings(), same = back.Findings();
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_EQ(findings[0].message.find(
                "2 contours at centre heights from 3.0000 to 7.0000 mm: a resolution of 0.1 mm"),
            0u)
      << findings[0].message;
  EXPECT_NE(findings[0].message.find(" 0.4 mm is held"), std::string::npos) << findings[0].message;
  EXPECT_EQ(findings[1].message.find(
                "3 contours at centre heights from 3.0000 to 7.0000 mm: 543 cells of up to 0.0500 mm"),
            0u)
      << findings[1].message;
  for (std::size_t i = 0; i < findings.size(); ++i) {
    EXPECT_EQ(findings[i].where.point, Vec3(2.0, 0.0, 0.0));
    EXPECT_EQ(findings[i].message, same[i].message);
    EXPECT_EQ(findings[i].where.point, same[i].where.point);
  }
}

// Large flats with open borders and a small tool: what is looked at grows with the border, not with the
// flat.
TEST(ContourLimits, LargePlatesKeepTheResolution) {
  const double a = 150.0, radius = 0.3, rho = 0.2;
  const TracedModel plate(testing::Plane(a), radius);
  const double c = std::sqrt(radius * radius - rho * rho);
  const LevelContours level = plate.At(c);
  EXPECT_EQ(level.cell, plate.params.resolution / 8.0);
  EXPECT_EQ(level.z, c);
  EXPECT_EQ(level.ambiguous_cells, 0);
  ASSERT_EQ(level.loops.size(), 1u);
  for (const CutterPoint& p : level.loops[0].points)
    EXPECT_NEAR(RectangleDistance(Xy(p.center), a, a), rho, 1e-9);
}

}  // namespace
}  // namespace patchmill
