// The deepest point of a branch: closed forms, and the conditions of a minimum.
#include "cam/location/ray_slide.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/surface/closest.h"
#include "tests/cam/path/zlevel/level_checks.h"
#include "tests/support/shapes.h"
#include "tests/support/walls.h"

namespace patchmill {
namespace {

using testing::MakeSurface;

// Slides until nothing moves; how many steps that took.
int Settle(RaySlide& slide, const Vec3& c) {
  for (int k = 1; k <= 100; ++k) {
    if (slide.Step(c) < 1e-12) return k;
  }
  return 101;
}

SurfacePoint At(const Surface& surface, PieceId piece, double u, double v) {
  return {piece, u, v, Position(surface.piece(piece), u, v)};
}

TEST(RaySlide, NearestPointOfASphere) {
  const Surface surface = MakeSurface(testing::Sphere(Vec3::Zero(), 10.0));
  for (std::size_t i = 0; i < surface.pieces.size(); ++i) {
    const PieceId piece(i);
    const Vec3 truth = At(surface, piece, 0.4, 0.6).p;
    if (truth.z() <= 0.0) continue;  // seen from above
    RaySlide slide(surface, At(surface, piece, 0.7, 0.3));
    EXPECT_LE(Settle(slide, 1.3 * truth), 12);
    EXPECT_LE((slide.at().p - truth).norm(), 1e-9);
    EXPECT_EQ(slide.held_by(), -1);
  }
}

TEST(RaySlide, AboveTheCentreOnlyThePlanCounts) {
  // A cylinder along y: beside its lower half the nearest generator to the ray is the one at the equator.
  const Surface surface = MakeSurface(testing::Cylinder(Vec3::Zero(), 5.0, 10.0));
  for (std::size_t i = 0; i < surface.pieces.size(); ++i) {
    const SurfacePoint from = At(surface, PieceId(i), 0.5, 0.5);
    if (from.p.x() < 0.0 || from.p.z() < 0.0) continue;
    RaySlide slide(surface, from);
    Settle(slide, Vec3(7.0, 1.0, -4.0));
    EXPECT_NEAR(std::hypot(slide.at().p.x(), slide.at().p.z()), 5.0, 1e-12);
    EXPECT_NEAR(slide.at().p.x(), 5.0, 1e-9);
  }
}

// The wall waves by some hundredths of a micrometre, so that steps aim at its ends and stop on the way. A
// side holds a point only on that side.
TEST(RaySlide, AShortenedStepIsNotHeld) {
  const Surface surface = MakeSurface(testing::WavingBox(20.0, 15.0, 12.0, 1e-4));
  for (int k = 0; k <= 40; ++k) {
    RaySlide slide(surface, At(surface, PieceId(1), 0.38, k / 40.0));
    for (int step = 0; step < 20; ++step) {
      slide.Step(Vec3(-5.0, -12.0, 5.0));
      const SurfacePoint& at = slide.at();
      const bool on[] = {at.v == 0.0, at.u == 1.0, at.v == 1.0, at.u == 0.0};
      EXPECT_TRUE(slide.held_by() < 0 || on[slide.held_by()]) << at.u << " " << at.v;
    }
    EXPECT_NEAR(slide.at().p.x(), -5.0, 1e-3);
  }
}

TEST(RaySlide, HeldByTheSideOfAPlate) {
  const Surface surface = MakeSurface(testing::Plane(10.0, 0.0, 0.0, 0.0));
  RaySlide slide(surface, At(surface, PieceId(0), 0.2, 0.2));
  Settle(slide, Vec3(12.0, 3.0, 1.0));
  EXPECT_LE((slide.at().p - Vec3(10.0, 3.0, 0.0)).norm(), 1e-12);
  EXPECT_EQ(slide.held_by(), 1);
}

// Never farther than the start, and no step of either parameter alone would come nearer.
TEST(RaySlide, EndsAtAMinimum) {
  const Surface surface = MakeSurface(testing::RandomBspline(3, {.folds = true, .rational = true}));
  int inside = 0;
  for (std::size_t i = 0; i < surface.pieces.size(); ++i) {
    const SurfacePoint from = At(surface, PieceId(i), 0.3, 0.8);
    const Vec3 c = from.p + Vec3(0.7, -0.4, 1.9);
    const auto distance = [&](const Vec3& p) {
      return std::hypot(p.x() - c.x(), p.y() - c.y(), std::max(0.0, c.z() - p.z()));
    };
    RaySlide slide(surface, from);
    ASSERT_LE(Settle(slide, c), 100);
    const SurfacePoint& at = slide.at();
    const double found = distance(at.p);
    EXPECT_LE(found, distance(from.p) + 1e-12);
    for (const auto& [du, dv] : {std::pair{1e-4, 0.0}, {-1e-4, 0.0}, {0.0, 1e-4}, {0.0, -1e-4}}) {
      const double u = std::clamp(at.u + du, 0.0, 1.0), v = std::clamp(at.v + dv, 0.0, 1.0);
      EXPECT_GE(distance(Position(surface.piece(PieceId(i)), u, v)), found - 1e-10);
    }
    inside += slide.held_by() < 0;
    const auto nearest = ClosestToUpwardRay(surface, c, kInfinity, 1e-9);
    ASSERT_TRUE(nearest.has_value());
    EXPECT_GE(found, nearest->distance - 2e-9);
  }
  EXPECT_GT(inside, 5);
}

}  // namespace
}  // namespace patchmill
