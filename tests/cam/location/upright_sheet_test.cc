// Upright walls: which patches are upright, and what lies beside them in plan, against exact circles and
// brute force.
#include "cam/location/upright_sheet.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "cam/location/locator.h"
#include "cam/location/search_tree.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"
#include "tests/support/walls.h"

namespace patchmill {
namespace {

using namespace patchmill::testing;
using internal::OutsideInXy;
using internal::XyCurve;
using internal::XyCurveOf;

constexpr double kRounding = 1e-13;

// Swept by heights that need not be the same along the curve.
std::vector<Vec4> Sweep(const std::vector<Vec3>& curve, int heights, Random& random) {
  std::vector<Vec4> net;
  for (const Vec3& p : curve) {
    for (int j = 0; j < heights; ++j)
      net.emplace_back(p.x(), p.y(), p.z() * (j + random.Uniform(0, 0.5)), p.z());
  }
  return net;
}

// A quarter of a circle around the origin.
std::vector<Vec3> Quarter(double radius) {
  const double w = std::sqrt(0.5);
  return {{radius, 0, 1}, {w * radius, w * radius, w}, {0, radius, 1}};
}

Vec2 At(const XyCurve& curve, double t) {
  std::vector<Vec4> p(curve.points.begin(), curve.points.begin() + curve.degree + 1);
  for (std::size_t n = p.size(); n > 1; --n) {
    for (std::size_t k = 0; k + 1 < n; ++k) p[k] = (1.0 - t) * p[k] + t * p[k + 1];
  }
  return p[0].head<2>() / p[0].w();
}

TEST(XyCurveOf, KnowsUprightSheetsEitherWay) {
  Random random(3);
  const std::vector<Vec4> net = Sweep(Quarter(5.0), 4, random);
  const auto curve = XyCurveOf({2, 3}, net.data(), kRounding);
  ASSERT_TRUE(curve);
  EXPECT_EQ(curve->degree, 2);
  EXPECT_LT(curve->spread, 1e-12);
  std::vector<Vec4> turned(net.size());
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 4; ++j) turned[j * 3 + i] = net[i * 4 + j];
  }
  const auto other = XyCurveOf({3, 2}, turned.data(), kRounding);
  ASSERT_TRUE(other);
  EXPECT_EQ(other->degree, 2);
  for (const double t : {0.0, 0.3, 1.0}) EXPECT_NEAR((At(*curve, t) - At(*other, t)).norm(), 0.0, 1e-15);
}

TEST(UprightLines, AreFoundEitherWay) {
  using internal::Upright;
  using internal::UprightLinesOf;
  Random random(5);
  const std::vector<Vec4> net = Sweep(Quarter(5.0), 4, random);
  EXPECT_EQ(UprightLinesOf({2, 3}, net.data(), kRounding), Upright::kAlongV);
  std::vector<Vec4> turned(net.size()), down = net, bent = net, slanted = net, mixed = net;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 4; ++j) turned[j * 3 + i] = net[i * 4 + j];
    for (std::size_t j = 0; j < 4; ++j) down[i * 4 + j] = net[i * 4 + 3 - j];
  }
  EXPECT_EQ(UprightLinesOf({3, 2}, turned.data(), kRounding), Upright::kAlongU);
  EXPECT_EQ(UprightLinesOf({2, 3}, down.data(), kRounding), Upright::kAlongV);
  bent[5].z() = 20.0;  // above the end of its line
  EXPECT_EQ(UprightLinesOf({2, 3}, bent.data(), kRounding), Upright::kNo);
  slanted[5].x() += 1e-9;
  EXPECT_EQ(UprightLinesOf({2, 3}, slanted.data(), kRounding), Upright::kNo);
  for (std::size_t j = 0; j < 4; ++j) mixed[j].z() *= -1.0;  // one line falls, the others rise
  EXPECT_EQ(UprightLinesOf({2, 3}, mixed.data(), kRounding), Upright::kNo);
}

// Only the upper edge of a wall decides: its height costs nothing.
TEST(UprightLines, AHighWallHasAsManyLeavesAsALowOne) {
  const auto leaves = [](double height) {
    const Surface surface = SurfaceOf(Walls(20.0, 15.0, 0.0, height));
    const auto tree = internal::BuildSearchTree(surface, 3.0, RunContext());
    PM_CHECK(tree.ok());
    return tree->leaves.size();
  };
  const std::size_t low = leaves(10.0);
  EXPECT_LE(leaves(1000.0), 3 * low);
  EXPECT_GE(leaves(1000.0), low / 3);
}

// Walls whose highest points are inside: z does not rise along all vertical lines. Heights against dense
// samples.
TEST(UprightLines, AWallWithAHumpKeepsItsInside) {
  BezierPatch wall{1, 2, {}, {}};
  for (const double x : {0.0, 10.0}) {
    for (const double z : {0.0, 20.0, 2.0}) wall.points.emplace_back(x, 0.0, z);
  }
  const Surface surface = SurfaceOf(Single(wall));
  const Locator locator(surface, 3.0);
  double highest = 0.0;
  for (int k = 0; k <= 1000; ++k) {
    const double t = k / 1000.0;
    highest = std::max(highest, 2 * t * (1 - t) * 20.0 + t * t * 2.0);
  }
  for (const double y : {0.0, 1.0, 2.9}) {
    const auto h = locator.Height(Vec2(5.0, y));
    ASSERT_TRUE(h);
    EXPECT_NEAR(h->z, highest + std::sqrt(9.0 - y * y), 1e-4);
  }
}

// Balls low beside a high wall, at every height: free at the radius, not free nearer.
TEST(UprightLines, BallsLowBesideAHighWall) {
  const Surface surface = SurfaceOf(Walls(20.0, 15.0, 0.0, 100.0));
  const Locator locator(surface, 3.0);
  for (const double z : {-10.0, 3.0, 50.0, 96.9}) {
    EXPECT_TRUE(locator.Free(Vec3(17.0 - 1e-7, 0.0, z)));
    EXPECT_FALSE(locator.Free(Vec3(17.0 + 1e-4, 0.0, z)));
    EXPECT_FALSE(locator.GougeWithin(Vec3(17.01, -5, z), Vec3(17.01, 5, z), 0.009, 1e-4));
    EXPECT_TRUE(locator.GougeWithin(Vec3(17.01, -5, z), Vec3(17.01, 5, z), 0.011, 1e-4));
  }
}

// A cone that stands upright but for its lean (rad), from radius `foot` at z = 0 up to `height`.
PatchModel Cone(double foot, double height, double lean) {
  PatchModel model;
  const double top = foot - height * std::tan(lean), w = std::sqrt(0.5);
  for (int quarter = 0; quarter < 4; ++quarter) {
    const double t = quarter * kPi / 2;
    const Vec2 a(std::cos(t), std::sin(t)), c(-a.y(), a.x()), b = a + c;
    BezierPatch patch{2, 1, {}, {1, 1, w, w, 1, 1}};
    for (const Vec2& p : {a, b, c}) {
      patch.points.push_back(Lift(foot * p, 0.0));
      patch.points.push_back(Lift(top * p, height));
    }
    model.patches.push_back({"", std::move(patch)});
  }
  return model;
}

// Balls that rest on the side of a cone, low and high, against the closed form of a ball beside a straight
// line: free where they rest and outside of it, not free a little inside.
TEST(LeaningWalls, BallsRestOnTheSideOfACone) {
  constexpr double kFoot = 15.0, kHeight = 30.0, kRadius = 3.0;
  for (const double lean : {1e-2, 1e-3, 2e-4, 5e-5, 1e-6, 1e-8}) {
    SCOPED_TRACE(lean);
    const Surface surface = SurfaceOf(Cone(kFoot, kHeight, lean));
    const Locator locator(surface, kRadius);
    for (const double contact : {0.5, 11.0, 29.5}) {
      for (const double angle : {0.3, 2.0, kPi / 2}) {
        const Vec2 out(std::cos(angle), std::sin(angle));
        const double z = contact + kRadius * std::sin(lean);
        const double axis = kFoot - contact * std::tan(lean) + kRadius * std::cos(lean);
        EXPECT_TRUE(locator.Free(Lift((axis + 1e-7) * out, z))) << contact << " " << angle;
        EXPECT_FALSE(locator.Free(Lift((axis - 1e-6) * out, z))) << contact << " " << angle;
        EXPECT_TRUE(locator.Free(Lift((axis - 1e-6) * out, z + 2e-6 / std::tan(lean)))) << contact;
      }
    }
  }
}

// A wall that leans by less than kWallSlope has few and high leaves, one that leans more many low ones.
TEST(LeaningWalls, LeavesAreHighWhereTheLeanIsSmall) {
  const auto leaves = [](double height, double lean) {
    const Surface surface = SurfaceOf(Cone(15.0, height, lean));
    const auto tree = internal::BuildSearchTree(surface, 3.0, RunContext());
    PM_CHECK(tree.ok());
    return tree->leaves.size();
  };
  for (const double lean : {5e-5, 1e-6}) EXPECT_LE(5 * leaves(60.0, lean), leaves(60.0, 1e-3)) << lean;
}

// A contact that leaves a floor at the foot of a wall wanders up to the wall's edge.
TEST(UprightLines, ContactsComeOntoAWallAtItsFoot) {
  const Surface surface = SurfaceOf(OpenBox(20.0, 15.0, 5.0));
  const Locator locator(surface, 3.0);
  const auto up = locator.Follow({PieceId(0), 0.99, 0.5, Vec3(19.6, 0, 0)}, Vec2(21.0, 0.0));
  ASSERT_TRUE(up);
  EXPECT_NEAR(up->z, 5.0 + std::sqrt(8.0), 1e-9);
}

TEST(XyCurveOf, KnowsOthers) {
  Random random(4);
  const std::vector<Vec4> upright = Sweep(Quarter(5.0), 3, random);
  for (std::size_t k = 0; k < upright.size(); ++k) {
    std::vector<Vec4> net = upright;
    net[k].x() += 1e-11;
    EXPECT_FALSE(XyCurveOf({2, 2}, net.data(), kRounding)) << k;
    net = upright;
    net[k].w() *= 1.0 + 1e-12;
    EXPECT_FALSE(XyCurveOf({2, 2}, net.data(), kRounding)) << k;
    net = upright;
    net[k].w() = 0.0;
    EXPECT_FALSE(XyCurveOf({2, 2}, net.data(), kRounding)) << k;
  }
}

// A circle that touches the curve from outside or inside: 1e-10 mm decide.
TEST(OutsideInXy, TellsACircleThatTouchesFromOneThatCuts) {
  Random random(5);
  const std::vector<Vec4> net = Sweep(Quarter(9.0), 2, random);
  const auto curve = XyCurveOf({2, 1}, net.data(), kRounding);
  ASSERT_TRUE(curve);
  for (int i = 0; i < 200; ++i) {
    const double angle = random.Uniform(0.05, 0.5 * kPi - 0.05), radius = random.Uniform(0.5, 6.0);
    const Vec2 out(std::cos(angle), std::sin(angle));
    for (const double side : {1.0, -1.0}) {
      const Vec2 q = (9.0 + side * radius) * out;
      EXPECT_TRUE(OutsideInXy(*curve, q, radius - 1e-10));
      EXPECT_FALSE(OutsideInXy(*curve, q, radius + 1e-10));
    }
  }
}

TEST(OutsideInXy, IsRightAboutRandomCurves) {
  Random random(6);
  int outside = 0, inside = 0;
  for (int i = 0; i < 300; ++i) {
    const int degree = 1 + i % 15;
    std::vector<Vec3> points;
    for (int k = 0; k <= degree; ++k) {
      const double w = random.Uniform(0.5, 2.0);
      points.emplace_back(w * random.Uniform(-5, 5), w * random.Uniform(-5, 5), w);
    }
    const std::vector<Vec4> net = Sweep(points, 2, random);
    const auto curve = XyCurveOf({degree, 1}, net.data(), kRounding);
    ASSERT_TRUE(curve);
    const Vec2 q(random.Uniform(-6, 6), random.Uniform(-6, 6));
    double nearest = kInfinity;
    for (int k = 0; k <= 4000; ++k) nearest = std::min(nearest, (At(*curve, k / 4000.0) - q).norm());
    const double radius = random.Uniform(0.2, 6.0);
    const bool is_outside = OutsideInXy(*curve, q, radius);
    // Between two of the 4001 places the curve may come a little nearer.
    if (nearest < radius) {
      EXPECT_FALSE(is_outside);
      ++inside;
    } else if (nearest > radius + 0.01) {
      EXPECT_TRUE(is_outside) << nearest << " " << radius;
      ++outside;
    }
  }
  EXPECT_GT(outside, 80);
  EXPECT_GT(inside, 80);
}

// A ball beside an upright wall, however near, is proven free, and one that cuts into it is not.
TEST(UprightWalls, AreProvenBesideTheBall) {
  Eigen::Affine3d up = Eigen::Affine3d::Identity();
  up.rotate(Eigen::AngleAxisd(0.5 * kPi, Vec3::UnitX()));
  const double wall = 9.0, radius = 3.0;
  const Surface surface = SurfaceOf(Transformed(Cylinder(Vec3::Zero(), wall, 8.0), up));
  const Locator locator(surface, radius);
  Random random(7);
  for (int i = 0; i < 200; ++i) {
    const double angle = random.Uniform(0.0, 2.0 * kPi), z = random.Uniform(-7.0, 4.0);
    for (const double side : {1.0, -1.0}) {
      const double at = wall + side * (radius + 2e-10);
      const auto lift = locator.CertifiedFree({at * std::cos(angle), at * std::sin(angle), z}, 1e-6);
      ASSERT_TRUE(lift) << angle << " " << side;
      EXPECT_LE(*lift, 1e-6);
      const double in = wall + side * (radius - 1e-6);
      EXPECT_FALSE(locator.Free({in * std::cos(angle), in * std::sin(angle), z}));
    }
  }
}

}  // namespace
}  // namespace patchmill
