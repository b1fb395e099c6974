// What the verifier demands of vertical faces, and the reasons it reports for unreachable places.
#include "cam/verify/reach.h"

#include <array>
#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "tests/support/reach_definition.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

constexpr double kRadius = 3.0;

ReachParams Params() {
  ReachParams params;
  params.radius = kRadius;
  params.reach_tolerance = 0.01;
  return params;
}

// A sheet y = c z^2 below z = 0, where it stands upright and ends; above it a lid keeps the tool off its
// back.
PatchModel UprightRim() {
  BezierPatch sheet;
  sheet.degree_u = 1;
  sheet.degree_v = 2;
  // z from 0 to -6: y = 0, 0, 3.6.
  for (const double x : {-10.0, 10.0}) {
    for (const Vec2& p : {Vec2(0, 0), Vec2(0, -3), Vec2(3.6, -6)}) sheet.points.emplace_back(x, p.x(), p.y());
  }
  BezierPatch lid;
  lid.degree_u = lid.degree_v = 1;
  for (const double x : {-10.0, 10.0}) {
    for (const double y : {0.5, 20.0}) lid.points.emplace_back(x, y, 1.0);
  }
  return Join({Single(sheet), Single(lid)});
}

TEST(VerifyReach, ARimThatStandsUprightByNoMoreThanALineIsAsWhatLiesBesideIt) {
  const Surface surface = SurfaceOf(UprightRim());
  Obstacles obstacles;
  for (const double u : {0.1, 0.37, 0.5, 0.9}) {
    const SurfacePoint rim{PieceId(0), u, 0.0, Position(surface.piece(PieceId(0)), u, 0.0)};
    const auto facing = FacingAt(Evaluate(surface, rim.piece, rim.u, rim.v));
    ASSERT_TRUE(facing && facing->both);
    EXPECT_EQ(ReachAt(surface, rim.p, *facing, Params()), ReachClass::kReachable) << "the ball touches it";
    EXPECT_EQ(ReachOn(surface, rim, *facing, Params(), obstacles), ReachClass::kUndercut);
  }
}

TEST(VerifyReach, WallsAndEquatorsAreToBeFinished) {
  for (const PatchModel& model : {Block(10.0, 12.0, 30.0), Sphere(Vec3::Zero(), 8.0, Half::kUpper),
                                  Cylinder(Vec3::Zero(), 5.0, 20.0, Half::kUpper)}) {
    const Surface surface = SurfaceOf(model);
    Obstacles obstacles;
    int upright = 0;
    for (std::size_t piece = 0; piece < surface.pieces.size(); ++piece) {
      for (int k = 0; k < 21 * 21; ++k) {
        const double u = k / 21 / 20.0, v = k % 21 / 20.0;
        const SurfaceJet jet = Evaluate(surface, PieceId(piece), u, v);
        const auto facing = FacingAt(jet);
        if (!facing || !facing->both) continue;
        const ReachClass own = ReachAt(surface, jet.p, *facing, Params());
        if (own != ReachClass::kReachable) continue;
        ++upright;
        EXPECT_EQ(ReachOn(surface, {PieceId(piece), u, v, jet.p}, *facing, Params(), obstacles), own)
            << jet.p.transpose();
      }
    }
    EXPECT_GT(upright, 20);
  }
}

std::optional<ReachClass> ByDefinition(const Surface& surface, const Vec3& p, const Vec3& e) {
  const auto blocked = ReachByDefinition(surface, p, e, kRadius, Params().reach_tolerance);
  if (!blocked) return std::nullopt;
  if (blocked == Blocked::kNot) return ReachClass::kReachable;
  return blocked == Blocked::kAbove ? ReachClass::kUndercut : ReachClass::kConcave;
}

// Two half spheres, one a millimetre inside the other: undercut, however thin it is for the ball.
PatchModel ThinDome() {
  return Join({Sphere(Vec3::Zero(), 12.0, Half::kUpper), Sphere(Vec3::Zero(), 11.0, Half::kUpper)});
}

TEST(VerifyReach, ReasonsAreThoseOfTheDefinitionFreshOrWithWhatIsKnown) {
  std::array<int, 3> seen{};
  int all = 0, close = 0;
  for (const PatchModel& model :
       {Join({Plane(20.0), Sphere(Vec3(0, 0, 9.0), 6.0)}), Torus(Vec3::Zero(), 12.0, 4.0),
        TwoSpheres(8.0, 13.0), ThinDome(), RandomBspline(11, {.spans = 5, .size = 30.0, .folds = true}),
        Single(RandomBezier(3, 5, 5, true, 30.0))}) {
    const Surface surface = SurfaceOf(model);
    Obstacles obstacles;  // kept from place to place, as the verifier does
    for (std::size_t piece = 0; piece < surface.pieces.size(); ++piece) {
      for (int k = 0; k < 15 * 15; ++k) {
        const SurfaceJet jet = Evaluate(surface, PieceId(piece), (k / 15 + 0.5) / 15, (k % 15 + 0.5) / 15);
        const auto facing = FacingAt(jet);
        if (!facing || facing->both) continue;
        ++all;
        const auto expected = ByDefinition(surface, jet.p, facing->e);
        if (!expected) {
          ++close;
          continue;
        }
        ++seen[static_cast<std::size_t>(*expected)];
        EXPECT_EQ(ReachAt(surface, jet.p, *facing, Params(), obstacles), *expected) << jet.p.transpose();
        EXPECT_EQ(ReachAt(surface, jet.p, *facing, Params()), *expected) << jet.p.transpose();
      }
    }
  }
  for (const int count : seen) EXPECT_GT(count, 200);
  EXPECT_LT(close, all / 20);
}

}  // namespace
}  // namespace patchmill
