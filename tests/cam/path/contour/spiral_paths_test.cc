// Spirals: on the true offset of known shapes, free, within the chord tolerance on both sides, no farther
// apart than the contours they were, and only where contours lie one below the other.
#include "cam/path/contour/spiral_paths.h"

#include <cmath>

#include <gtest/gtest.h>

#include "cam/path/contour/contour_paths.h"
#include "core/diffgeo/forms.h"
#include "tests/cam/path/zlevel/level_checks.h"
#include "tests/support/leftover.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using testing::Half;
using testing::MakeSurface;

constexpr double kR = 3.0;

struct Wound {
  explicit Wound(PatchModel model, bool backwards = false, double steep = Radians(45.0), int threads = 2)
      : surface(MakeSurface(std::move(model))), locator(surface, kR) {
    params.pass.window.min = steep;
    params.pass.floor_z = 0.0;
    const RunContext run(threads);
    const auto contours = ContourPaths(locator, params, run);
    EXPECT_TRUE(contours.ok()) << contours.status();
    levels = contours->paths;
    const auto spirals = SpiralPaths(locator, levels, params.pass, backwards, run);
    EXPECT_TRUE(spirals.ok()) << spirals.status();
    paths = *spirals;
  }
  int Spirals() const {
    int n = 0;
    for (const CutterPath& p : paths) n += p.traversal == Traversal::kSpiral;
    return n;
  }

  ContourParams params;
  Surface surface;
  Locator locator;
  std::vector<CutterPath> levels, paths;
};

// Falls all the way between whole levels, every vertex free, every chord short enough for [location T2].
void CheckShape(const Wound& wound, const CutterPath& spiral) {
  EXPECT_EQ(spiral.kind, PassKind::kContour);
  EXPECT_FALSE(spiral.closed);
  ASSERT_GT(spiral.points.size(), 10u);
  const double top = spiral.points.front().center.z(), bottom = spiral.points.back().center.z();
  std::size_t whole_top = 0, whole_bottom = 0;
  for (std::size_t i = 0; i < spiral.points.size(); ++i) {
    const CutterPoint& p = spiral.points[i];
    ASSERT_TRUE(p.contact.has_value());
    EXPECT_TRUE(wound.locator.Free(p.center, 2e-9)) << p.center.transpose();
    whole_top += p.center.z() == top;
    whole_bottom += std::abs(p.center.z() - bottom) < 1e-12;
    if (i == 0) continue;
    const Vec3 move = p.center - spiral.points[i - 1].center;
    EXPECT_LE(move.z(), 1e-12) << "rises at vertex " << i;
    const double half = 0.5 * move.norm();
    EXPECT_LE(kR - std::sqrt(kR * kR - half * half), wound.params.pass.chord_tolerance);
  }
  EXPECT_GT(whole_top, 6u);
  EXPECT_GT(whole_bottom, 6u);
}

// Largest leftover and deepest gouge over a grid of steep points a free ball touches, by brute force.
struct Extremes {
  double leftover = 0.0, gouge = 0.0;
  int points = 0;
};
Extremes Measure(const Wound& wound, int n, double slope_from) {
  const testing::DistanceToPaths distance(wound.paths);
  Extremes e;
  for (std::size_t i = 0; i < wound.surface.pieces.size(); ++i) {
    for (int k = 0; k < n * n; ++k) {
      const SurfaceJet jet = Evaluate(wound.surface, PieceId(i), (k / n + 0.5) / n, (k % n + 0.5) / n);
      const double d = distance.At(jet.p, kR + 0.5);
      e.gouge = std::max(e.gouge, kR - d);
      const auto normal = UpwardNormal(jet);
      if (!normal || std::acos(normal->z()) < slope_from) continue;
      const Vec3 c = jet.p + kR * *normal;
      if (c.z() < kR || !wound.locator.Free(c, 1e-9)) continue;
      e.leftover = std::max(e.leftover, d - kR);
      ++e.points;
    }
  }
  return e;
}

PatchModel DomeOnAPlane() {
  return testing::Join({testing::Sphere(Vec3::Zero(), 10.0, Half::kUpper), testing::Plane(25.0)});
}

TEST(SpiralPaths, OnePassDownADome) {
  const Wound wound(DomeOnAPlane());
  ASSERT_GT(wound.levels.size(), 5u);
  ASSERT_EQ(wound.paths.size(), 1u);
  const CutterPath& spiral = wound.paths.front();
  ASSERT_EQ(spiral.traversal, Traversal::kSpiral);
  CheckShape(wound, spiral);
  double turned = 0.0;
  for (std::size_t i = 0; i < spiral.points.size(); ++i) {
    EXPECT_NEAR(spiral.points[i].center.norm(), 13.0, 1e-8);  // on the offset sphere, at every height
    if (i == 0) continue;
    const Vec2 a = Xy(spiral.points[i - 1].center), b = Xy(spiral.points[i].center);
    turned += std::atan2(Cross(a, b), a.dot(b));
    // Both sides of every chord: its middle is nowhere farther from the dome than the tolerance.
    const Vec3 middle = 0.5 * (spiral.points[i - 1].center + spiral.points[i].center);
    EXPECT_LE(std::abs(middle.norm() - 13.0), wound.params.pass.chord_tolerance);
  }
  // One turn between two levels, and both end levels whole; clockwise is climb.
  EXPECT_NEAR(turned / (-2.0 * kPi), static_cast<double>(wound.levels.size()) + 1.0, 0.05);
  EXPECT_EQ(spiral.points.front().center.z(), wound.levels.front().points.front().center.z());
  EXPECT_NEAR(spiral.points.back().center.z(), wound.levels.back().points.front().center.z(), 1e-12);
  const Extremes e = Measure(wound, 60, wound.params.pass.window.min);
  EXPECT_GT(e.points, 1000);
  EXPECT_LE(e.leftover, wound.params.pass.scallop + 0.0075);
  EXPECT_LE(e.gouge, wound.params.pass.chord_tolerance);
}

TEST(SpiralPaths, BackwardsFallsToo) {
  const Wound wound(DomeOnAPlane(), true);
  ASSERT_EQ(wound.paths.size(), 1u);
  const CutterPath& spiral = wound.paths.front();
  CheckShape(wound, spiral);
  const Vec2 a = Xy(spiral.points[0].center), b = Xy(spiral.points[1].center);
  EXPECT_GT(Cross(a, b), 0.0) << "counter-clockwise around a mountain is conventional";
}

TEST(SpiralPaths, DownIntoABowl) {
  const Eigen::Affine3d over = Eigen::Translation3d(0, 0, 12) * Eigen::AngleAxisd(kPi, Vec3::UnitX());
  const Wound wound(testing::Transformed(testing::Sphere(Vec3::Zero(), 12.0, Half::kUpper), over));
  ASSERT_EQ(wound.Spirals(), 1);
  for (const CutterPath& path : wound.paths) {
    if (path.traversal != Traversal::kSpiral) continue;
    CheckShape(wound, path);
    for (const CutterPoint& p : path.points) EXPECT_NEAR((p.center - Vec3(0, 0, 12)).norm(), 9.0, 1e-8);
  }
  const Extremes e = Measure(wound, 60, wound.params.pass.window.min);
  EXPECT_GT(e.points, 500);
  EXPECT_LE(e.leftover, wound.params.pass.scallop + 0.0075);
  EXPECT_LE(e.gouge, wound.params.pass.chord_tolerance);
}

TEST(SpiralPaths, AroundABlocksVerticalWalls) {
  const Wound wound(testing::Block(8.0, 5.0, 20.0));
  ASSERT_EQ(wound.Spirals(), 1);
  for (const CutterPath& path : wound.paths) {
    if (path.traversal != Traversal::kSpiral) continue;
    CheckShape(wound, path);
    // The offset of the square, rounded at its corners.
    for (const CutterPoint& p : path.points) {
      if (p.center.z() > 5.0) continue;
      const Vec2 out = Xy(p.center).cwiseAbs() - Vec2(8.0, 8.0);
      EXPECT_NEAR(out.cwiseMax(0.0).norm(), kR, 1e-6);
    }
  }
  EXPECT_LE(Measure(wound, 60, Radians(80.0)).leftover, wound.params.pass.scallop + 0.0075);
}

TEST(SpiralPaths, CornersBetweenTwoDomesAreKept) {
  // Two domes that share their lower levels: a spiral down each, one around both, corners wound through.
  const Wound wound(testing::TwoSpheres(10.0, 12.0), false, Radians(20.0));
  EXPECT_EQ(wound.Spirals(), 3);
  std::size_t whole = 0;
  for (const CutterPath& level : wound.levels) whole += level.closed;
  EXPECT_LT(wound.paths.size(), wound.levels.size());
  EXPECT_GT(whole, 10u);
  for (const CutterPath& path : wound.paths) {
    if (path.traversal != Traversal::kSpiral) continue;
    CheckShape(wound, path);
    for (const CutterPoint& p : path.points) {
      const double left = (p.center - Vec3(-6, 0, 0)).norm(), right = (p.center - Vec3(6, 0, 0)).norm();
      EXPECT_NEAR(std::min(left, right), 13.0, 1e-8);
    }
  }
  const Extremes e = Measure(wound, 60, Radians(50.0));
  EXPECT_LE(e.leftover, wound.params.pass.scallop + 0.0075);
  EXPECT_LE(e.gouge, wound.params.pass.chord_tolerance);
}

TEST(SpiralPaths, OpenContoursStay) {
  // A sheet: its contours run from border to border.
  const Wound wound(testing::Cylinder(Vec3::Zero(), 10.0, 10.0, Half::kUpper));
  ASSERT_FALSE(wound.levels.empty());
  EXPECT_EQ(wound.Spirals(), 0);
  ASSERT_EQ(wound.paths.size(), wound.levels.size());
  for (std::size_t i = 0; i < wound.paths.size(); ++i) {
    ASSERT_EQ(wound.paths[i].points.size(), wound.levels[i].points.size());
    EXPECT_EQ(wound.paths[i].points.front().center, wound.levels[i].points.front().center);
  }
}

TEST(SpiralPaths, SameForAnyNumberOfThreads) {
  const Wound one(DomeOnAPlane(), false, Radians(45.0), 1), four(DomeOnAPlane(), false, Radians(45.0), 4);
  ASSERT_EQ(one.paths.size(), four.paths.size());
  for (std::size_t i = 0; i < one.paths.size(); ++i) {
    ASSERT_EQ(one.paths[i].points.size(), four.paths[i].points.size());
    for (std::size_t k = 0; k < one.paths[i].points.size(); ++k)
      EXPECT_EQ(one.paths[i].points[k].center, four.paths[i].points[k].center);
  }
}

}  // namespace
}  // namespace patchmill
