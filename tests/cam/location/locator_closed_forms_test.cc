// h against closed forms ([location, section 12]): 1e-9 mm.
#include <cmath>

#include <gtest/gtest.h>

#include "cam/location/locator.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using testing::Random;
using testing::SurfaceOf;

constexpr double kExact = 1e-9;

// Height and certified height at q are both `truth`; the proof closes.
void ExpectHeight(const Locator& locator, const Vec2& q, double truth) {
  const auto h = locator.Height(q);
  ASSERT_TRUE(h.has_value()) << q.transpose();
  EXPECT_NEAR(h->z, truth, kExact) << "q = " << q.transpose();
  EXPECT_NEAR((h->contact.p - Lift(q, h->z)).norm(), locator.radius(), 1e-9) << "q = " << q.transpose();
  const auto certified = locator.CertifiedHeight(q, 1e-6);
  ASSERT_TRUE(certified.has_value());
  EXPECT_NEAR(certified->z, truth, kExact) << "q = " << q.transpose();
  EXPECT_LE(certified->gap, 1e-6 + 1e-9) << "q = " << q.transpose();
}

TEST(ClosedForms, InclinedPlane) {
  const double sx = 0.4, sy = -0.7;
  const Surface surface = SurfaceOf(testing::Plane(50.0, 2.0, sx, sy));
  const Locator locator(surface, 3.0);
  const double secant = std::sqrt(1.0 + sx * sx + sy * sy);
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    const Vec2 q(random.Uniform(-40, 40), random.Uniform(-40, 40));
    ExpectHeight(locator, q, 2.0 + sx * q.x() + sy * q.y() + 3.0 * secant);
  }
}

TEST(ClosedForms, SteepPlane) {
  const double sx = std::tan(Radians(85.0));
  const Surface surface = SurfaceOf(testing::Plane(10.0, 0.0, sx, 0.0));
  const Locator locator(surface, 3.0);
  Random random(2);
  for (int i = 0; i < 300; ++i) {
    const Vec2 q(random.Uniform(-9, 6), random.Uniform(-9, 9));
    ExpectHeight(locator, q, sx * q.x() + 3.0 * std::sqrt(1.0 + sx * sx));
  }
}

TEST(ClosedForms, OpenStraightBorderRollsOver) {
  // Beyond the border of a plane the ball rests on the edge x = 10, z = 4.
  const Surface surface = SurfaceOf(testing::Plane(10.0, 4.0));
  const Locator locator(surface, 3.0);
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    const double d = random.Uniform(0.0, 2.999);
    ExpectHeight(locator, {10.0 + d, random.Uniform(-9, 9)}, 4.0 + std::sqrt(9.0 - d * d));
  }
  // Around the corner: a vertex contact.
  for (int i = 0; i < 300; ++i) {
    const double d = random.Uniform(0.0, 2.999), phi = random.Uniform(0.0, kPi / 2);
    ExpectHeight(locator, {10.0 + d * std::cos(phi), 10.0 + d * std::sin(phi)}, 4.0 + std::sqrt(9.0 - d * d));
  }
  EXPECT_FALSE(locator.Height({13.0 + 1e-7, 0.0}).has_value());
  EXPECT_FALSE(locator.CertifiedHeight({13.0 + 1e-7, 0.0}, 1e-6).has_value());
  EXPECT_TRUE(locator.Height({13.0 - 1e-9, 0.0}).has_value());
}

TEST(ClosedForms, SphereOutside) {
  const Surface surface = SurfaceOf(testing::Sphere(Vec3(5, -3, 1), 10.0));
  const Locator locator(surface, 3.0);
  Random random(4);
  for (int i = 0; i < 500; ++i) {
    const double d = random.Uniform(0.0, 12.99), phi = random.Uniform(0.0, 2 * kPi);
    const Vec2 q(5 + d * std::cos(phi), -3 + d * std::sin(phi));
    ExpectHeight(locator, q, 1.0 + std::sqrt(169.0 - d * d));
  }
  ExpectHeight(locator, {5, -3}, 14.0);  // the pole: a degenerate edge
  EXPECT_FALSE(locator.Height({5 + 13.0 + 1e-7, -3}).has_value());
}

TEST(ClosedForms, CylinderAlongItsAxisAndOverItsOpenEnd) {
  const Surface surface = SurfaceOf(testing::Cylinder(Vec3(0, 0, 0), 8.0, 20.0));
  const Locator locator(surface, 3.0);
  Random random(5);
  for (int i = 0; i < 500; ++i) {
    const double x = random.Uniform(-10.9, 10.9);
    ExpectHeight(locator, {x, random.Uniform(-19, 19)}, std::sqrt(121.0 - x * x));
  }
  for (int i = 0; i < 300; ++i) {
    // Over the end the ball rests on the rim circle: max over x' of sqrt(64 - x'^2) + sqrt(9 - d^2 -
    // (x-x')^2), two circles of radii 8 and rho about 0 and x: collinear centres.
    const double d = random.Uniform(0.0, 2.9), rho = std::sqrt(9.0 - d * d);
    const double x = random.Uniform(-0.99, 0.99) * (8.0 + rho);
    ExpectHeight(locator, {x, 20.0 + d}, std::sqrt((8.0 + rho) * (8.0 + rho) - x * x));
  }
}

TEST(ClosedForms, TorusOutsideInsideAndThroughTheHole) {
  const double major = 20.0, minor = 6.0, r = 3.0;
  const Surface surface = SurfaceOf(testing::Torus(Vec3(1, 2, 3), major, minor));
  const Locator locator(surface, r);
  Random random(6);
  for (int i = 0; i < 600; ++i) {
    const double rho = random.Uniform(11.001, 28.999), phi = random.Uniform(0.0, 2 * kPi);
    const Vec2 q(1 + rho * std::cos(phi), 2 + rho * std::sin(phi));
    const double d = rho - major;
    ExpectHeight(locator, q, 3.0 + std::sqrt((minor + r) * (minor + r) - d * d));
  }
  EXPECT_FALSE(locator.Height({1, 2}).has_value());
}

TEST(ClosedForms, ValleyOfTwoPlanes) {
  const double angle = Radians(30.0);
  const Surface surface = SurfaceOf(testing::TwoPlanes(angle, 20.0));
  const Locator locator(surface, 3.0);
  Random random(7);
  for (int i = 0; i < 500; ++i) {
    const double x = random.Uniform(-15, 15);
    ExpectHeight(locator, {x, random.Uniform(-19, 19)},
                 std::abs(x) * std::tan(angle) + 3.0 / std::cos(angle));
  }
  ExpectHeight(locator, {0.0, 1.0}, 3.0 / std::cos(angle));
}

TEST(ClosedForms, RidgeOfTwoPlanesIsRolledOver) {
  const double angle = Radians(40.0), r = 3.0;
  const Surface surface = SurfaceOf(testing::TwoPlanes(-angle, 30.0));
  const Locator locator(surface, r);
  Random random(8);
  for (int i = 0; i < 500; ++i) {
    const double x = random.Uniform(-15, 15);
    const double truth = std::abs(x) <= r * std::sin(angle)
                             ? std::sqrt(r * r - x * x)
                             : -std::abs(x) * std::tan(angle) + r / std::cos(angle);
    ExpectHeight(locator, {x, random.Uniform(-25, 25)}, truth);
  }
}

TEST(ClosedForms, BlockWithVerticalWallsOnAFloor) {
  const double half = 10.0, height = 8.0, r = 3.0;
  const Surface surface = SurfaceOf(testing::Block(half, height, 40.0));
  const Locator locator(surface, r);
  Random random(9);
  for (int i = 0; i < 300; ++i) {
    ExpectHeight(locator, {random.Uniform(-10, 10), random.Uniform(-10, 10)}, height + r);
    const double d = random.Uniform(0.0, r - 1e-6);
    ExpectHeight(locator, {half + d, random.Uniform(-10, 10)}, height + std::sqrt(r * r - d * d));
    ExpectHeight(locator, {half + r + random.Uniform(1e-9, 20.0), random.Uniform(-30, 30)}, r);
  }
  for (const double e : {1e-3, 1e-6, 1e-9}) {  // the jump is at R exactly
    const double d = r - e;
    ExpectHeight(locator, {half + d, 1.0}, height + std::sqrt(r * r - d * d));
    ExpectHeight(locator, {half + r + e, 1.0}, r);
  }
}

TEST(ClosedForms, LoneSteepWallsNearTheEquator) {
  // The contact climbs a wall that the ball touches near its equator: from any start to the upper edge.
  const double r = 3.0, height = 10.0;
  for (const double lean : {0.0, 1e-9, 1e-6, 1e-3}) {  // outward at the top, so that the top is nearest to q
    const Surface surface = SurfaceOf(
        testing::Single(testing::Bilinear({0, -20, 0}, {0, 20, 0}, {lean, -20, height}, {lean, 20, height})));
    const Locator locator(surface, r);
    Random random(14);
    for (int i = 0; i < 200; ++i) {
      const double d = r - std::pow(10.0, random.Uniform(-8.0, 0.0));
      ExpectHeight(locator, {lean + d, random.Uniform(-19, 19)}, height + std::sqrt(r * r - d * d));
    }
  }
}

TEST(ClosedForms, TwoSpheresSwitchOnTheMiddlePlane) {
  const double radius = 6.0, distance = 10.0, r = 3.0;
  const Surface surface = SurfaceOf(testing::TwoSpheres(radius, distance));
  const Locator locator(surface, r);
  Random random(10);
  for (int i = 0; i < 500; ++i) {
    const Vec2 q(random.Uniform(-10, 10), random.Uniform(-4, 4));
    const double dx = std::abs(q.x()) - 0.5 * distance;
    const double d2 = dx * dx + q.y() * q.y();
    if (d2 > 70.0) continue;
    const double bound = (radius + r) * (radius + r) - d2;
    ExpectHeight(locator, q, std::sqrt(bound));
  }
}

TEST(ClosedForms, ParabolicValleyTighterThanTheBall) {
  // z = a x^2 with 2 a R = 1.8 > 1: two contacts. On x = 0: contact at x with sqrt(R^2 - x^2) = 1/(2a).
  const double r = 3.0, a = 0.3;
  const Surface surface = SurfaceOf(testing::ParabolicValley(a, 12.0));
  const Locator locator(surface, r);
  const double s = 0.5 / a;
  for (double y = -10.0; y <= 10.0; y += 0.37) {
    ExpectHeight(locator, {0.0, y}, a * (r * r - s * s) + s);
  }
  // Elsewhere: the centre above the contact x0 on its normal; the far branch is lower.
  Random random(11);
  const double contact = std::sqrt(r * r - s * s);
  for (int i = 0; i < 300; ++i) {
    const double x0 = random.Uniform(contact + 1e-3, 8.0), n = std::sqrt(1.0 + 4 * a * a * x0 * x0);
    ExpectHeight(locator, {x0 - r * 2 * a * x0 / n, random.Uniform(-10, 10)}, a * x0 * x0 + r / n);
  }
}

TEST(ClosedForms, ParabolaThatJustFits) {
  // 2 a R = 1: the maximum at the bottom is flat of fourth order.
  const double r = 3.0, a = 0.5 / r;
  const Surface surface = SurfaceOf(testing::ParabolicValley(a, 12.0));
  const Locator locator(surface, r);
  for (double y = -10.0; y <= 10.0; y += 0.73) ExpectHeight(locator, {0.0, y}, r);
  for (const double x0 : {1e-6, 1e-4, 1e-3, 1e-2, 0.1, 1.0, 5.0}) {
    const double n = std::sqrt(1.0 + 4 * a * a * x0 * x0);
    ExpectHeight(locator, {x0 - r * 2 * a * x0 / n, 0.3}, a * x0 * x0 + r / n);
  }
}

TEST(ClosedForms, SaddleAtItsPointAndOnItsAxes) {
  const double a = 0.05, b = 0.03, r = 3.0;
  const Surface surface = SurfaceOf(testing::Saddle(a, b, 20.0));
  const Locator locator(surface, r);
  ExpectHeight(locator, {0, 0}, r);
  Random random(12);
  for (int i = 0; i < 300; ++i) {  // any contact: its normal leads to the centre
    const double x = random.Uniform(-15, 15), y = random.Uniform(-15, 15);
    const Vec3 n = Vec3(-2 * a * x, 2 * b * y, 1).normalized();
    const Vec3 c = Vec3(x, y, a * x * x - b * y * y) + r * n;
    ExpectHeight(locator, Xy(c), c.z());
  }
}

TEST(ClosedForms, ConeTipIsAVertexContact) {
  // Ruled quads that close at the tip (0,0,10); base square of half side 10 at z = 0.
  PatchModel model;
  const Vec3 tip(0, 0, 10), base[4] = {{-10, -10, 0}, {10, -10, 0}, {10, 10, 0}, {-10, 10, 0}};
  for (int k = 0; k < 4; ++k) {
    model.patches.push_back({"", testing::Bilinear(base[k], base[(k + 1) % 4], tip, tip)});
  }
  const Surface surface = SurfaceOf(model);
  const double r = 3.0;
  const Locator locator(surface, r);
  Random random(13);
  const double reach = r / std::sqrt(2.0);  // the faces rise at 45 degrees
  for (int i = 0; i < 500; ++i) {
    const Vec2 q(random.Uniform(-9, 9), random.Uniform(-9, 9));
    const double m = std::max(std::abs(q.x()), std::abs(q.y())),
                 l = std::min(std::abs(q.x()), std::abs(q.y()));
    double truth = -kInfinity;
    if (m <= reach) {  // tip or an edge; edges fall along (1,1,-1)
      truth = std::max(truth, 10.0 + std::sqrt(r * r - q.squaredNorm() > 0 ? r * r - q.squaredNorm() : 0.0));
      if (q.squaredNorm() > r * r) truth = -kInfinity;
    }
    // Face contact: q moved back by R n_xy must be on the face.
    const double foot = m - reach;
    if (foot >= l) truth = std::max(truth, 10.0 - foot + reach);
    // Edge contact at (t, t, 10 - t): maximise over t.
    const double aq = std::abs(q.x()), bq = std::abs(q.y());
    const double mean = 0.5 * (aq + bq), off2 = 0.5 * (aq - bq) * (aq - bq);
    if (off2 < r * r) {  // distance^2 = off2 + 2 (t - mean)^2
      const double rho2 = r * r - off2;
      // 10 - t + sqrt(rho2 - 2 (t - mean)^2): optimum at t = mean - sqrt(rho2 / 6)
      const double t = std::max(0.0, mean - std::sqrt(rho2 / 6.0));
      const double inside = rho2 - 2 * (t - mean) * (t - mean);
      if (inside >= 0) truth = std::max(truth, 10.0 - t + std::sqrt(inside));
    }
    ExpectHeight(locator, q, truth);
  }
}

TEST(ClosedForms, GapAsWideAsTheBall) {
  // Two walls 2R -+ 1e-6 apart over a floor at 0: the ball sits on the rims or falls through.
  const double r = 3.0, top = 5.0;
  for (const double e : {-1e-6, 1e-6}) {
    const double w = r + 0.5 * e;
    PatchModel model;
    for (const double side : {-1.0, 1.0}) {
      model.patches.push_back({"", testing::Bilinear({side * w, -20, 0}, {side * w, 20, 0},
                                                     {side * w, -20, top}, {side * w, 20, top})});
      model.patches.push_back({"", testing::Bilinear({side * w, -20, top}, {side * w, 20, top},
                                                     {side * 20, -20, top}, {side * 20, 20, top})});
    }
    model.patches.push_back({"", testing::Bilinear({-w, -20, 0}, {w, -20, 0}, {-w, 20, 0}, {w, 20, 0})});
    const Surface surface = SurfaceOf(model);
    const Locator locator(surface, r);
    ExpectHeight(locator, {0.0, 0.1}, e < 0 ? top + std::sqrt(r * r - w * w) : r);
  }
}

}  // namespace
}  // namespace patchmill
