#include "core/surface/closest.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/core/surface/surface_models.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using testing::MakeSurface;
using testing::Random;

enum class To { kPoint, kRay };

std::optional<ClosestPoint> Closest(To to, const Surface& s, const Vec3& c, double limit, double tolerance) {
  return to == To::kPoint ? ClosestToPoint(s, c, limit, tolerance)
                          : ClosestToUpwardRay(s, c, limit, tolerance);
}

double DistanceTo(To to, const Vec3& p, const Vec3& c) {
  Vec3 d = p - c;
  if (to == To::kRay && d.z() > 0.0) d.z() = 0.0;
  return d.norm();
}

// Smallest distance over grids of samples, the best few of them improved by pattern search: an upper bound of
// the truth that shares nothing with the code under test but the evaluation.
class Oracle {
 public:
  Oracle(const Surface& s, int cells) : surface_(s) {
    for (std::size_t i = 0; i < s.pieces.size(); ++i) {
      for (int k = 0; k <= cells; ++k) {
        for (int l = 0; l <= cells; ++l) {
          const double u = static_cast<double>(k) / cells, v = static_cast<double>(l) / cells;
          samples_.push_back({PieceId(i), u, v, Position(s.pieces[i], u, v)});
        }
      }
    }
    step_ = 1.0 / cells;
  }

  double Distance(To to, const Vec3& c) const {
    std::vector<SurfacePoint> best(8);
    std::partial_sort_copy(samples_.begin(), samples_.end(), best.begin(), best.end(),
                           [&](const SurfacePoint& a, const SurfacePoint& b) {
                             return DistanceTo(to, a.p, c) < DistanceTo(to, b.p, c);
                           });
    double distance = kInfinity;
    for (SurfacePoint& start : best) distance = std::min(distance, Improve(to, c, start));
    return distance;
  }

 private:
  double Improve(To to, const Vec3& c, SurfacePoint at) const {
    double f = DistanceTo(to, at.p, c);
    for (double step = step_; step > 1e-8;) {
      bool better = false;
      for (int k = 0; k < 9; ++k) {
        const double u = std::clamp(at.u + step * (k / 3 - 1), 0.0, 1.0);
        const double v = std::clamp(at.v + step * (k % 3 - 1), 0.0, 1.0);
        const Vec3 p = Position(surface_.piece(at.piece), u, v);
        if (DistanceTo(to, p, c) < f) {
          f = DistanceTo(to, p, c);
          at = {at.piece, u, v, p};
          better = true;
        }
      }
      if (!better) step *= 0.5;
    }
    return f;
  }

  const Surface& surface_;
  std::vector<SurfacePoint> samples_;
  double step_ = 0.0;
};

// What every answer promises, whatever the truth.
void ExpectHonest(To to, const Surface& s, const Vec3& c, const ClosestPoint& found) {
  ASSERT_LT(found.at.piece.index(), s.pieces.size());
  EXPECT_GE(found.at.u, 0.0);
  EXPECT_LE(found.at.u, 1.0);
  EXPECT_GE(found.at.v, 0.0);
  EXPECT_LE(found.at.v, 1.0);
  EXPECT_LT((Position(s.piece(found.at.piece), found.at.u, found.at.v) - found.at.p).norm(), 1e-11);
  EXPECT_NEAR(DistanceTo(to, found.at.p, c), found.distance, 1e-11);
}

// No sample may be nearer than the answer by more than the tolerance; the answer is a point of the surface,
// hence never nearer than the truth.
void ExpectNearest(To to, const Surface& s, const Oracle& oracle, const Vec3& c, double tolerance) {
  const auto found = Closest(to, s, c, kInfinity, tolerance);
  ASSERT_TRUE(found.has_value());
  ExpectHonest(to, s, c, *found);
  const double truth = oracle.Distance(to, c);
  EXPECT_LE(found->distance, truth + tolerance + 1e-11) << c.transpose();

  // The limit: just above the answer it is found, just below nothing is.
  const auto above = Closest(to, s, c, found->distance + 2.0 * tolerance, tolerance);
  ASSERT_TRUE(above.has_value());
  EXPECT_NEAR(above->distance, found->distance, tolerance);
  if (found->distance > 4.0 * tolerance) {
    EXPECT_FALSE(Closest(to, s, c, found->distance - tolerance - 1e-11, tolerance).has_value());
  }
  // The first one, just as sure.
  const auto first = to == To::kRay ? FirstNearUpwardRay : FirstNearPoint;
  for (const double limit : {found->distance + 2.0 * tolerance, 2.0 * found->distance + 1.0}) {
    const auto some = first(s, c, limit, tolerance);
    ASSERT_TRUE(some.has_value());
    ExpectHonest(to, s, c, *some);
    EXPECT_LT(some->distance, limit);
  }
  if (found->distance > 4.0 * tolerance) {
    EXPECT_FALSE(first(s, c, found->distance - tolerance - 1e-11, tolerance).has_value());
  }
}

Vec3 NearBox(Random& random, const Box3& box, double margin) {
  const Vec3 t = random.Point(0.0, 1.0);
  const Vec3 low = box.min - Vec3::Constant(margin), high = box.max + Vec3::Constant(margin);
  return low + t.cwiseProduct(high - low);
}

class EveryShape : public ::testing::TestWithParam<testing::NamedModel> {};

TEST_P(EveryShape, AgreesWithDenseSampling) {
  const Surface s = MakeSurface(GetParam().model, 0.05);
  const Oracle oracle(
      s, std::max(8, static_cast<int>(std::sqrt(40000.0 / static_cast<double>(s.pieces.size())))));
  Random random(7);
  const double margin = 0.2 * s.box.Diagonal();
  for (int i = 0; i < 25; ++i) {
    const Vec3 c = NearBox(random, s.box, margin);
    for (const To to : {To::kPoint, To::kRay}) {
      for (const double tolerance : {1e-2, 1e-6}) ExpectNearest(to, s, oracle, c, tolerance);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Closest, EveryShape, ::testing::ValuesIn(testing::EveryKindOfPatch()),
                         [](const auto& model) { return model.param.name; });

constexpr double kTight = 1e-9;

TEST(Closest, PointToPlane) {
  const Surface s = MakeSurface(testing::Plane(50.0, 1.0, 0.5, -0.25));
  const Vec3 n = Vec3(-0.5, 0.25, 1.0).normalized();
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const Vec3 c = random.Point(-20.0, 20.0);
    const auto found = ClosestToPoint(s, c, kInfinity, kTight);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->distance, std::abs(n.dot(c - Vec3(0, 0, 1.0))), 2.0 * kTight);
  }
}

TEST(Closest, RayToPlaneIsTheRayAboveIt) {
  const Surface s = MakeSurface(testing::Plane(50.0, 1.0, 0.5, -0.25));
  const Vec3 n = Vec3(-0.5, 0.25, 1.0).normalized();
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const Vec3 c = random.Point(-20.0, 20.0);
    const double height = n.dot(c - Vec3(0, 0, 1.0));
    const auto found = ClosestToUpwardRay(s, c, kInfinity, kTight);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->distance, std::max(0.0, height), 2.0 * kTight);  // a ray from below pierces it
  }
}

TEST(Closest, PointToSphereEverywhereAndAtItsCentre) {
  const Vec3 center(3, -2, 1);
  const Surface s = MakeSurface(testing::Sphere(center, 10.0));
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const Vec3 c = center + random.Point(-16.0, 16.0);
    const auto found = ClosestToPoint(s, c, kInfinity, kTight);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->distance, std::abs((c - center).norm() - 10.0), 2.0 * kTight);
  }
  // Every point of the sphere is nearest: nothing to branch on.
  const auto found = ClosestToPoint(s, center, kInfinity, kTight);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->distance, 10.0, 2.0 * kTight);
  // Near the poles, where the patches have no normal.
  for (const double z : {-14.0, -6.0, 6.0, 14.0}) {
    for (const double x : {0.0, 1e-9, 1e-3}) {
      const Vec3 at = center + Vec3(x, 0, z);
      const auto polar = ClosestToPoint(s, at, kInfinity, kTight);
      ASSERT_TRUE(polar);
      EXPECT_NEAR(polar->distance, std::abs(Vec3(x, 0, z).norm() - 10.0), 2.0 * kTight);
    }
  }
}

TEST(Closest, PointToTorusAndCylinder) {
  const Surface torus = MakeSurface(testing::Torus(Vec3::Zero(), 20.0, 6.0));
  const Surface cylinder = MakeSurface(testing::Cylinder(Vec3::Zero(), 8.0, 40.0));
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    const Vec3 c = random.Point(-30.0, 30.0);
    const double around = std::hypot(std::hypot(c.x(), c.y()) - 20.0, c.z());
    const auto to_torus = ClosestToPoint(torus, c, kInfinity, kTight);
    ASSERT_TRUE(to_torus);
    EXPECT_NEAR(to_torus->distance, std::abs(around - 6.0), 2.0 * kTight);
    const auto to_cylinder = ClosestToPoint(cylinder, c, kInfinity, kTight);
    ASSERT_TRUE(to_cylinder);
    EXPECT_NEAR(to_cylinder->distance, std::abs(std::hypot(c.x(), c.z()) - 8.0), 2.0 * kTight);
  }
  // On the circle of tube centres a whole circle is nearest, on the axis of the cylinder all of it.
  const auto centre_line = ClosestToPoint(torus, {0, 20, 0}, kInfinity, kTight);
  ASSERT_TRUE(centre_line);
  EXPECT_NEAR(centre_line->distance, 6.0, 2.0 * kTight);
  const auto axis = ClosestToPoint(cylinder, {0, 5, 0}, kInfinity, kTight);
  ASSERT_TRUE(axis);
  EXPECT_NEAR(axis->distance, 8.0, 2.0 * kTight);
}

TEST(Closest, RayUpThroughATorusTouchesItsInnerSide) {
  const Surface s = MakeSurface(testing::Torus(Vec3::Zero(), 20.0, 6.0));
  // A ray from below along the axis passes the inner equator, wherever it starts below it.
  for (const double z : {-30.0, -6.0, -1.0, 0.0}) {
    const auto found = ClosestToUpwardRay(s, {0.5, 0, z}, kInfinity, kTight);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->distance, 13.5, 2.0 * kTight);
    EXPECT_NEAR(found->at.p.z(), 0.0, 1e-3);
  }
  // From above the equator the start of the ray counts.
  const auto found = ClosestToUpwardRay(s, {0.5, 0, 7.0}, kInfinity, kTight);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->distance, std::hypot(19.5, 7.0) - 6.0, 2.0 * kTight);
}

TEST(Closest, AboveNothingThatIsAboveIsLeftOut) {
  const Surface s = MakeSurface(testing::Torus(Vec3::Zero(), 10.0, 4.0));
  std::vector<Vec3> samples;
  for (const Piece& piece : s.pieces) {
    for (int k = 0; k < 400; ++k) samples.push_back(Position(piece, k % 20 / 19.0, k / 20 / 19.0));
  }
  Random random(5);
  int above = 0, below = 0, none = 0, low = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 c = random.Point(-15, 15).cwiseProduct(Vec3(1, 1, 0.4));
    const double limit = random.Uniform(0.5, 8.0);
    const auto found = ClosestAbove(s, c, limit, 1e-6);
    const double proven = (found ? found->distance : limit) - 1e-6;
    for (const Vec3& p : samples) EXPECT_FALSE(p.z() > c.z() && (Xy(p) - Xy(c)).norm() < proven);
    // What boxes alone say is a proof one way.
    const bool may = MayRiseAbove(s, c, limit);
    EXPECT_TRUE(may || !found || !(found->at.p.z() > c.z()));
    low += !may;
    if (found) {
      EXPECT_NEAR(DistanceTo(To::kRay, found->at.p, c), found->distance, 1e-12);
    }
    // Where the nearest of all is above, it is the same.
    const auto all = ClosestToUpwardRay(s, c, limit, 1e-6);
    if (all && all->at.p.z() > c.z()) {
      ASSERT_TRUE(found);
      EXPECT_NEAR(found->distance, all->distance, 2e-6);
    }
    (!found ? none : found->at.p.z() > c.z() ? above : below) += 1;
  }
  EXPECT_GT(low, 20);
  EXPECT_GT(above, 50);
  EXPECT_GT(below, 5);
  EXPECT_GT(none, 50);
}

TEST(Closest, RayAlongAVerticalWall) {
  const Surface s = MakeSurface(testing::Block(10.0, 8.0, 30.0));
  // Beside the wall: the wall as long as the start is lower than its top, then its upper edge.
  for (const double z : {0.5, 3.0, 7.9}) {
    const auto found = ClosestToUpwardRay(s, {13.0, 1.0, z}, kInfinity, kTight);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->distance, std::min(3.0, z), 2.0 * kTight);
  }
  const auto edge = ClosestToUpwardRay(s, {13.0, 1.0, 12.0}, kInfinity, kTight);
  ASSERT_TRUE(edge);
  EXPECT_NEAR(edge->distance, 5.0, 2.0 * kTight);  // 3-4-5
  const auto corner = ClosestToPoint(s, {11.0, 12.0, 10.0}, kInfinity, kTight);
  ASSERT_TRUE(corner);
  EXPECT_NEAR(corner->distance, 3.0, 2.0 * kTight);  // 1-2-2
}

// The ball in a bowl of its own radius under a wall: a half sphere and a cylinder of nearest points, which a
// search by boxes would cut into millions.
TEST(Closest, BallInItsOwnBowl) {
  const double r = 5.0;
  PatchModel bowl = testing::Transformed(testing::Sphere(Vec3::Zero(), r, testing::Half::kUpper),
                                         Eigen::Affine3d(Eigen::AngleAxisd(kPi, Vec3::UnitX())));
  PatchModel wall = testing::Transformed(testing::Cylinder(Vec3::Zero(), r, 4.0),
                                         Eigen::Affine3d(Eigen::AngleAxisd(kPi / 2, Vec3::UnitX())));
  wall = testing::Transformed(wall, Eigen::Affine3d(Eigen::Translation3d(0, 0, 4.0)));
  const Surface s = MakeSurface(testing::Join({bowl, wall}));
  const auto start = std::chrono::steady_clock::now();
  for (const double z : {0.0, 1e-6, 1e-3, 0.5, -1e-6, -1e-3, -0.5}) {
    for (const double tolerance : {1e-3, 1e-6}) {
      const auto found = ClosestToUpwardRay(s, {0, 0, z}, kInfinity, tolerance);
      ASSERT_TRUE(found);
      EXPECT_NEAR(found->distance, z < 0.0 ? r + z : r, 2.0 * tolerance) << z;
      EXPECT_FALSE(AnythingNearUpwardRay(s, {0, 0, z}, std::min(r, r + z) - 2.0 * tolerance, tolerance));
    }
  }
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 2.0);
}

TEST(Closest, APointOfTheSurfaceIsAtDistanceZero) {
  const Surface s = MakeSurface(testing::RandomBspline(5));
  Random random(6);
  for (int i = 0; i < 50; ++i) {
    const PieceId id(random.Int(static_cast<int>(s.pieces.size())));
    const Vec3 p = Position(s.piece(id), random.Unit(), random.Unit());
    const auto found = ClosestToPoint(s, p, kInfinity, 1e-8);
    ASSERT_TRUE(found);
    EXPECT_LE(found->distance, 1e-8);
    EXPECT_TRUE(AnythingNearUpwardRay(s, p, 1e-6, 1e-8));
  }
}

TEST(Closest, NotANumberFindsNothing) {
  const Surface s = MakeSurface(testing::Plane(1.0));
  EXPECT_FALSE(ClosestToPoint(s, Vec3::Constant(std::nan("")), kInfinity, 1e-3));
  EXPECT_FALSE(ClosestToUpwardRay(s, Vec3(kInfinity, 0, 0), kInfinity, 1e-3));
}

TEST(Closest, DoesNotDependOnTheLeaves) {
  const PatchModel model = testing::RandomBspline(11, {.folds = true, .rational = true});
  const Surface coarse = MakeSurface(model, 5.0), fine = MakeSurface(model, 0.005);
  ASSERT_GT(fine.leaves.size(), 10 * coarse.leaves.size());
  Random random(12);
  for (int i = 0; i < 60; ++i) {
    const Vec3 c = NearBox(random, fine.box, 3.0);
    for (const To to : {To::kPoint, To::kRay}) {
      const auto a = Closest(to, coarse, c, kInfinity, 1e-8), b = Closest(to, fine, c, kInfinity, 1e-8);
      ASSERT_TRUE(a && b);
      EXPECT_NEAR(a->distance, b->distance, 2e-8);
    }
  }
}

TEST(Closest, MovesWithTheModel) {
  const PatchModel model = testing::RandomBspline(13, {.folds = true});
  Eigen::Affine3d motion = Eigen::Affine3d::Identity();
  motion.translate(Vec3(100, -50, 7)).rotate(Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()));
  const Surface a = MakeSurface(model), b = MakeSurface(testing::Transformed(model, motion));
  Random random(14);
  for (int i = 0; i < 60; ++i) {
    const Vec3 c = NearBox(random, a.box, 3.0);
    const auto at_a = ClosestToPoint(a, c, kInfinity, kTight);
    const auto at_b = ClosestToPoint(b, motion * c, kInfinity, kTight);
    ASSERT_TRUE(at_a && at_b);
    EXPECT_NEAR(at_a->distance, at_b->distance, 2.0 * kTight);
  }
}

}  // namespace
}  // namespace patchmill
