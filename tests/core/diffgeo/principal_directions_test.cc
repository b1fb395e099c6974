// Principal directions of a cylinder, a saddle, a sphere and a plane.
#include "core/diffgeo/principal_directions.h"

#include <cmath>

#include <gtest/gtest.h>

namespace patchmill {
namespace {

std::optional<PrincipalDirections> At(const SurfaceJet& jet) {
  return DirectionsOf(jet, Forms(jet, *UnitNormal(jet)));
}

// Does not tell a direction from its opposite.
double AngleBetween(const Vec3& a, const Vec3& b) { return a.cross(b).norm(); }

// (r cos u, r sin u, u + v): the parameters run askew to the principal directions.
SurfaceJet Cylinder(double r, double u) {
  SurfaceJet jet;
  jet.p = Vec3(r * std::cos(u), r * std::sin(u), u);
  jet.du = Vec3(-r * std::sin(u), r * std::cos(u), 1);
  jet.dv = Vec3(0, 0, 1);
  jet.duu = Vec3(-r * std::cos(u), -r * std::sin(u), 0);
  return jet;
}

TEST(PrincipalDirections, OfACylinderAreItsCirclesAndItsRulings) {
  for (const double u : {0.0, 0.7, 2.4}) {
    const auto directions = At(Cylinder(3.0, u));  // the normal points out: the circles have -1/3
    ASSERT_TRUE(directions.has_value());
    EXPECT_LE(AngleBetween(directions->min, Vec3(-std::sin(u), std::cos(u), 0)), 1e-14);
    EXPECT_LE(AngleBetween(directions->max, Vec3::UnitZ()), 1e-14);
  }
}

// z = x y bends up along x = y and down across it.
TEST(PrincipalDirections, OfASaddleAreItsDiagonals) {
  SurfaceJet jet;
  jet.du = Vec3::UnitX(), jet.dv = Vec3::UnitY(), jet.duv = Vec3::UnitZ();
  const auto directions = At(jet);
  ASSERT_TRUE(directions.has_value());
  EXPECT_LE(AngleBetween(directions->max, Vec3(1, 1, 0).normalized()), 1e-15);
  EXPECT_LE(AngleBetween(directions->min, Vec3(1, -1, 0).normalized()), 1e-15);
}

// The normal curvature along a direction is the principal curvature, for any forms.
TEST(PrincipalDirections, HaveThePrincipalCurvatures) {
  SurfaceJet jet;
  jet.du = Vec3(2, 0.3, 0.1), jet.dv = Vec3(-0.4, 1.5, 0.7);
  jet.duu = Vec3(0.1, 0.2, 0.9), jet.duv = Vec3(-0.3, 0.1, 0.4), jet.dvv = Vec3(0.2, 0.6, -0.5);
  const FundamentalForms f = Forms(jet, *UnitNormal(jet));
  const auto directions = DirectionsOf(jet, f);
  ASSERT_TRUE(directions.has_value());
  EXPECT_NEAR(NormalCurvature(f, jet, directions->min), Principal(f).k_min, 1e-14);
  EXPECT_NEAR(NormalCurvature(f, jet, directions->max), Principal(f).k_max, 1e-14);
  EXPECT_NEAR(directions->min.dot(directions->max), 0.0, 1e-15);
  EXPECT_NEAR(directions->min.dot(*UnitNormal(jet)), 0.0, 1e-15);
}

TEST(PrincipalDirections, AreFreeOnASphereAndOnAPlane) {
  SurfaceJet plane;
  plane.du = Vec3(2, 1, 0), plane.dv = Vec3(0.3, 1, 0);
  EXPECT_FALSE(At(plane).has_value());
  const double u = 0.4, v = 0.9, r = 5.0;  // longitude and latitude
  SurfaceJet sphere;
  sphere.du = r * Vec3(-std::sin(u) * std::cos(v), std::cos(u) * std::cos(v), 0);
  sphere.dv = r * Vec3(-std::cos(u) * std::sin(v), -std::sin(u) * std::sin(v), std::cos(v));
  sphere.duu = r * Vec3(-std::cos(u) * std::cos(v), -std::sin(u) * std::cos(v), 0);
  sphere.duv = r * Vec3(std::sin(u) * std::sin(v), -std::cos(u) * std::sin(v), 0);
  sphere.dvv = r * Vec3(-std::cos(u) * std::cos(v), -std::sin(u) * std::cos(v), -std::sin(v));
  EXPECT_FALSE(At(sphere).has_value());
}

}  // namespace
}  // namespace patchmill
