// What the verifier demands on upright ground.
#include "cam/verify/reach.h"

#include <gtest/gtest.h>

#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

constexpr double kRadius = 3.0;

ReachParams Params() {
  ReachParams params;
  params.radius = kRadius;
  params.tolerance = 0.01;
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

}  // namespace
}  // namespace patchmill
