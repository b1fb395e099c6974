// Curvatures of shapes with closed forms, and the shapes of tests/support themselves.
#include "core/diffgeo/forms.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using testing::Half;
using testing::Random;

// Calls check(jet) at random places of every patch, poles and borders included.
template <class Check>
void ForSamples(const PatchModel& model, int count, Check check) {
  Random random(11);
  for (const Patch& patch : model.patches) {
    for (int k = 0; k < count; ++k) {
      double u = random.Unit(), v = random.Unit();
      if (k % 5 == 0) u = std::round(u);
      if (k % 7 == 0) v = std::round(v);
      check(Evaluate(patch.shape, u, v));
    }
  }
}

TEST(Forms, SphereIsUmbilicAndOutward) {
  const Vec3 center(1, -2, 3);
  const double r = 10;
  int poles = 0, others = 0;
  ForSamples(testing::Sphere(center, r), 200, [&](const SurfaceJet& jet) {
    EXPECT_NEAR((jet.p - center).norm(), r, 1e-14 * r);
    const auto normal = UnitNormal(jet);
    if (!normal) {
      EXPECT_NEAR(std::abs(jet.p.z() - center.z()), r, 1e-12);
      ++poles;
      return;
    }
    ++others;
    const double rho = Xy(jet.p - center).norm() / r;  // |S_u| shrinks with it: so do the digits left
    EXPECT_LE((*normal - (jet.p - center) / r).norm(), 1e-14 / rho);
    const FundamentalForms f = Forms(jet, *normal);
    const PrincipalCurvatures k = Principal(f);
    EXPECT_NEAR(k.k_min, -1 / r, 1e-14 / (rho * rho));
    EXPECT_NEAR(k.k_max, -1 / r, 1e-14 / (rho * rho));
    EXPECT_NEAR(NormalCurvature(f, 0.3, -0.8), -1 / r, 1e-14 / (rho * rho));
    EXPECT_NEAR(ContourCurvature(jet, f), -1 / r, 1e-14 / (rho * rho));
  });
  EXPECT_GT(poles, 50);
  EXPECT_GT(others, 1000);
}

TEST(Forms, CylinderBendsOneWay) {
  const double r = 4;
  ForSamples(testing::Cylinder({0, 0, 0}, r, 7), 100, [&](const SurfaceJet& jet) {
    EXPECT_NEAR(std::hypot(jet.p.x(), jet.p.z()), r, 1e-14 * r);
    const Vec3 normal = UnitNormal(jet).value();
    EXPECT_NEAR(normal.x() * jet.p.x() + normal.z() * jet.p.z(), r, 1e-13 * r);
    const FundamentalForms f = Forms(jet, normal);
    EXPECT_NEAR(Principal(f).k_min, -1 / r, 1e-13);
    EXPECT_NEAR(Principal(f).k_max, 0, 1e-13);
    EXPECT_NEAR(NormalCurvature(f, jet, Vec3::UnitY()), 0, 1e-13);
    // Euler: k = k1 cos^2 of the angle to the circle; a part of t along the normal does not count.
    const Vec3 circle = normal.cross(Vec3::UnitY());
    EXPECT_NEAR(NormalCurvature(f, jet, 3 * circle + 4 * Vec3::UnitY() + 5 * normal), -9 / 25.0 / r, 1e-13);
  });
}

TEST(Forms, TorusHasItsTwoCurvatures) {
  const double major = 20, minor = 6;
  ForSamples(testing::Torus({0, 0, 0}, major, minor), 50, [&](const SurfaceJet& jet) {
    const double rho = std::hypot(jet.p.x(), jet.p.y());
    EXPECT_NEAR(std::hypot(rho - major, jet.p.z()), minor, 1e-13);
    const Vec3 normal = UnitNormal(jet).value();
    const double cos_angle = (rho - major) / minor;
    EXPECT_NEAR(normal.x() * jet.p.x() + normal.y() * jet.p.y(), cos_angle * rho, 1e-11);
    const FundamentalForms f = Forms(jet, normal);
    const double around = -cos_angle / rho;
    EXPECT_NEAR(Principal(f).k_min, std::min(-1 / minor, around), 1e-12);
    EXPECT_NEAR(Principal(f).k_max, std::max(-1 / minor, around), 1e-12);
    if (std::abs(jet.p.z()) < 0.99 * minor) {  // contours are circles around z
      EXPECT_NEAR(ContourCurvature(jet, f), around, 1e-10);
    }
  });
}

TEST(Forms, ContourOfParaboloidAndSaddle) {
  const double a = 0.08, b = 0.03;
  ForSamples(testing::Paraboloid(a, 10), 300, [&](const SurfaceJet& jet) {
    EXPECT_NEAR(jet.p.z(), a * jet.p.head<2>().squaredNorm(), 1e-14);
    const FundamentalForms f = Forms(jet, UpwardNormal(jet).value());
    const double rho = Xy(jet.p).norm();
    const double slope = std::atan(2 * a * rho);
    EXPECT_NEAR(ContourCurvature(jet, f), std::sin(slope) / rho, 1e-12);  // a basin
  });
  ForSamples(testing::Saddle(a, b, 10), 300, [&](const SurfaceJet& jet) {
    const double x = jet.p.x(), y = jet.p.y();
    EXPECT_NEAR(jet.p.z(), a * x * x - b * y * y, 1e-14);
    const Vec3 normal = UpwardNormal(jet).value();
    const FundamentalForms f = Forms(jet, normal);
    // In x, y: D = 8ab (b y^2 - a x^2) e_z; u, v are x, y stretched by 20, and D is of weight 4.
    const double expected = 8 * a * b * (b * y * y - a * x * x) * normal.z() * std::pow(20.0, 4);
    EXPECT_NEAR(ContourDeterminant(jet, f), expected, 1e-11 * std::pow(20.0, 4));
  });
}

TEST(Forms, FlatSpotHasNoContour) {
  const SurfaceJet top = Evaluate(testing::Paraboloid(0.1, 5).patches[0].shape, 0.5, 0.5);
  EXPECT_EQ(ContourCurvature(top, Forms(top, UnitNormal(top).value())), 0.0);
  const SurfaceJet flat = Evaluate(testing::Plane(5).patches[0].shape, 0.3, 0.6);
  EXPECT_EQ(ContourCurvature(flat, Forms(flat, UnitNormal(flat).value())), 0.0);
}

TEST(Forms, UpwardNormalTurnsUndersides) {
  const PatchModel all = testing::Sphere({0, 0, 0}, 3);
  ForSamples(all, 30, [&](const SurfaceJet& jet) {
    const auto normal = UnitNormal(jet), up = UpwardNormal(jet);
    ASSERT_EQ(normal.has_value(), up.has_value());
    if (!normal) return;
    EXPECT_GE(up->z(), 0.0);
    EXPECT_EQ(std::abs(normal->dot(*up)), normal->squaredNorm());
  });
}

TEST(Forms, DegenerateJetHasNoNormal) {
  SurfaceJet jet;
  EXPECT_FALSE(UnitNormal(jet));
  jet.du = Vec3(1e6, 0, 0);
  jet.dv = Vec3(1e6, 1e-8, 0);
  EXPECT_FALSE(UnitNormal(jet));
  jet.dv = Vec3(0, 1e-10, 1e-10);  // the noise that a pole leaves
  EXPECT_FALSE(UnitNormal(jet));
  jet.dv = Vec3(0, 1e-5, 0);
  ASSERT_TRUE(UnitNormal(jet));
  EXPECT_EQ(*UnitNormal(jet), Vec3::UnitZ());
}

}  // namespace
}  // namespace patchmill
