// Quick answers about balls in the way against the plain search, and limits of reach against closed forms.
#include "cam/region/reach/reach.h"

#include <cmath>

#include <gtest/gtest.h>

#include "cam/limits/reach_tolerance.h"
#include "cam/region/split/limit_follower.h"
#include "cam/region/split/reach_limits.h"
#include "core/diffgeo/forms.h"
#include "core/surface/closest.h"
#include "tests/support/random.h"
#include "tests/support/reach_definition.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

Surface Folded(std::uint64_t seed) {
  RandomBsplineParams part;
  part.size = 20.0;
  part.amplitude = 5.0;
  part.folds = true;
  return SurfaceOf(RandomBspline(seed, part));
}

TEST(ObstacleCloud, OfACancelledRunIsCutShort) {
  const Surface surface = SurfaceOf(Plane(20));
  const Vec3 low(0, 0, -1);
  RunContext run;
  EXPECT_TRUE(ObstacleCloud(surface, 0.4, run).InTheWay(low, 2.0));
  run.Cancel();
  EXPECT_FALSE(ObstacleCloud(surface, 0.4, run).InTheWay(low, 2.0));
}

TEST(ObstacleCloud, ItsPointsAreOfTheSurfaceAndInTheWay) {
  int found = 0;
  for (const std::uint64_t seed : {1u, 2u}) {
    const Surface surface = Folded(seed);
    const ObstacleCloud cloud(surface, 0.4, RunContext());
    Random random(seed);
    for (int i = 0; i < 300; ++i) {
      const Vec3 c = random.Point(-4, 24) - Vec3(0, 0, 10);
      const double radius = random.Uniform(0.3, 4.0);
      if (const auto p = cloud.InTheWay(c, radius)) {
        ++found;
        EXPECT_TRUE(ClosestToPoint(surface, p->p, 1e-9, 1e-10)) << p->p.transpose();
        EXPECT_LT((Evaluate(surface, p->piece, p->u, p->v).p - p->p).norm(), 1e-4);
        const Vec3 d = p->p - c;
        EXPECT_LT(std::hypot(d.x(), d.y(), std::min(d.z(), 0.0)), radius);
      }
      const auto nearest = ClosestToPoint(surface, c, kInfinity, 1e-6);
      ASSERT_TRUE(nearest);
      const auto point = cloud.Nearest(c, 50.0);
      ASSERT_TRUE(point);
      const double distance = (*point - c).norm();
      EXPECT_GE(distance, nearest->distance - 2e-6);
      EXPECT_LE(distance, nearest->distance + 3.0);  // folds stretch the patches
      EXPECT_FALSE(cloud.Nearest(c, distance * (1 - 1e-9)));
      EXPECT_EQ(cloud.Nearest(c, distance * (1 + 1e-9)), point);
    }
  }
  EXPECT_GT(found, 100);
}

// The definition [regions (6)], by distances alone. Nothing where it is too near to call. Places in
// groups: what is known from the last ones helps with the next.
TEST(ReachTest, AgreesWithTheDefinition) {
  int blocked = 0, above = 0, not_above = 0;
  for (const std::uint64_t seed : {3u, 4u, 5u}) {
    const Surface surface = Folded(seed);
    RegionParams params;
    params.radius = 1.5;
    const double free_radius = params.radius - ReachTolerance(params.tolerance);
    const Locator free_ball(surface, free_radius);
    const ReachTest reach(free_ball, params, RunContext());
    Random random(seed);
    std::vector<SurfaceJet> jets;
    for (int i = 0; i < 100; ++i) {
      const auto piece = static_cast<std::size_t>(random.Int(static_cast<int>(surface.pieces.size())));
      const double u = random.Uniform(0.0, 0.9), v = random.Uniform(0.0, 0.9);
      for (int k = 0; k < 8; ++k)
        jets.push_back(Evaluate(surface.pieces[piece], u + 0.1 * random.Unit(), v + 0.1 * random.Unit()));
    }
    std::vector<double> signs(jets.size()), undercut(jets.size());
    reach.BlockedAboveAt(jets, undercut);
    std::vector<std::optional<SurfacePoint>> obstacles(jets.size());
    reach.FreeAt(jets, signs, obstacles);
    for (std::size_t i = 0; i < jets.size(); ++i) {
      const auto facing = FacingAt(jets[i]);
      if (!facing || facing->e.z() < 1e-3) continue;
      const Vec3 center = jets[i].p + params.radius * facing->e;
      const auto ray = ClosestToUpwardRay(surface, center, kInfinity, 1e-6);
      ASSERT_TRUE(ray);
      if (std::abs(ray->distance - free_radius) > 1e-4) {
        EXPECT_EQ(signs[i], ray->distance > free_radius ? 1.0 : -1.0);
        EXPECT_EQ(reach.Free(jets[i].p, *facing), ray->distance > free_radius);
      }
      if (signs[i] > 0.0) continue;
      ++blocked;
      ASSERT_TRUE(obstacles[i]);
      EXPECT_LT(reach.Clearance(obstacles[i]->p, jets[i]), 0.0);
      const auto by =
          ReachByDefinition(surface, jets[i].p, facing->e, params.radius, ReachTolerance(params.tolerance));
      if (!by || by == Blocked::kNot) continue;
      const bool is_above = by == Blocked::kAbove;
      EXPECT_EQ(reach.BlockedAbove(jets[i].p, *facing), is_above);
      EXPECT_EQ(undercut[i], is_above ? -1.0 : 1.0);
      above += is_above;
      not_above += !is_above;
    }
  }
  EXPECT_GT(blocked, 200);
  EXPECT_GT(above, 20);
  EXPECT_GT(not_above, 20);
}

TEST(ReachLimits, AreThoseOfAHemisphereOnAPlane) {
  const double r = 8, radius = 3, tolerance = 0.01, half = 20;
  const Surface surface = SurfaceOf(Join({Plane(half), Sphere(Vec3::Zero(), r, Half::kUpper)}));
  RegionParams params;
  params.radius = radius;
  params.tolerance = tolerance;
  const Locator free_ball(surface, radius - ReachTolerance(tolerance));
  const ReachTest reach(free_ball, params, RunContext());
  // On the plane, outwards from the rim in all directions: free from this circle on.
  const double reached = r + radius - ReachTolerance(tolerance),
               limit = std::sqrt(reached * reached - radius * radius);
  std::vector<ZeroSegment> segments;
  for (int i = 0; i < 24; ++i) {
    const double angle = 2 * kPi * i / 24, from = 8.5 + 0.05 * i, to = 11.0 + 0.1 * i;
    const Vec2 along(std::cos(angle), std::sin(angle));
    const Vec2 middle(0.5, 0.5);
    segments.push_back({middle + from / (2 * half) * along, middle + to / (2 * half) * along});
  }
  for (const double exact : {0.1, 0.01, 1e-4}) {
    std::vector<double> limits(segments.size());
    ReachLimits(reach, surface.pieces[0], segments, exact, limits);
    for (std::size_t k = 0; k < segments.size(); ++k) {
      const Vec2 q = segments[k].from + limits[k] * (segments[k].to - segments[k].from);
      EXPECT_NEAR(Xy(Position(surface.pieces[0], q.x(), q.y())).norm(), limit, exact) << exact;
    }
  }
}

// Upper hemispheres on a plane, and the circles on it from which on a ball is free.
struct Bosses {
  double half, limit;
  RegionParams params;
  Surface surface;
  Locator free_ball;
  ReachTest reach;

  Bosses(double half_size, double r, const std::vector<double>& at_x)
      : half(half_size),
        limit(LimitAround(r)),
        surface(SurfaceOf(Model(half_size, r, at_x))),
        free_ball(surface, params.radius - ReachTolerance(params.tolerance)),
        reach(free_ball, params, RunContext()) {}
  // The place (mm) on the plane in its parameters.
  Vec2 Place(double x, double y) const { return {0.5 + x / (2 * half), 0.5 + y / (2 * half)}; }
  Vec2 InMm(const Vec2& q) const { return 2 * half * (q - Vec2(0.5, 0.5)); }

 private:
  static double LimitAround(double r) {
    const RegionParams p;
    const double reached = r + p.radius - ReachTolerance(p.tolerance);
    return std::sqrt(reached * reached - p.radius * p.radius);
  }
  static PatchModel Model(double half, double r, const std::vector<double>& at_x) {
    PatchModel model = Plane(half);
    for (const double x : at_x) model = Join({model, Sphere(Vec3(x, 0, 0), r, Half::kUpper)});
    return model;
  }
};

constexpr double kExact = 0.01;  // mm, of followed limits

// Beside a hemisphere, chord by chord around it: on the circle, as far beside the chord as it bulges.
TEST(LimitFollower, StaysOnTheLimitOfAHemisphereOnAPlane) {
  const Bosses boss(20, 8, {0.0});
  const auto on_limit = [&](double angle) {
    return boss.Place(boss.limit * std::cos(angle), boss.limit * std::sin(angle));
  };
  LimitFollower follower(boss.reach, boss.surface.pieces[0], kExact);
  for (const double turn : {0.02, 0.3, 1.0}) {
    for (double angle = 0.0; angle < 2 * kPi; angle += turn) {
      const ZeroSegment chord{on_limit(angle), on_limit(angle + turn)};
      const Vec2 way = chord.to - chord.from, across(-way.y(), way.x());
      const auto share = follower.Find(chord, across, -1.0, 1.0);
      ASSERT_TRUE(share) << angle;
      const Vec2 q = 0.5 * (chord.from + chord.to) + *share * across;
      EXPECT_NEAR(boss.InMm(q).norm(), boss.limit, 0.1 * kExact) << angle;
    }
    // Far outside there is none.
    const ZeroSegment off{on_limit(0.0) + Vec2(0.2, 0.0), on_limit(0.1) + Vec2(0.2, 0.0)};
    EXPECT_FALSE(follower.Find(off, Vec2(0.01, 0.0), -1.0, 1.0));
  }
}

// Two hemispheres side by side: what one of them leaves free the other may not.
TEST(LimitFollower, SeesWhatElseIsInTheWay) {
  const double apart = 6;
  const Bosses bosses(30, 5, {-apart, apart});
  ASSERT_GT(bosses.limit, apart);  // the circles cross
  const auto on_circle = [&](double x, double center) {
    return std::sqrt(bosses.limit * bosses.limit - (x - center) * (x - center));
  };
  const Vec2 across = bosses.Place(0.0, 4.0) - bosses.Place(0.0, 0.0);
  LimitFollower follower(bosses.reach, bosses.surface.pieces[0], kExact);
  const auto find = [&](double from, double to, double center) {
    const ZeroSegment chord{bosses.Place(from, on_circle(from, center)),
                            bosses.Place(to, on_circle(to, center))};
    const auto share = follower.Find(chord, across, -1.0, 1.0);
    return share ? bosses.InMm(0.5 * (chord.from + chord.to) + *share * across).y() : -1.0;
  };
  for (double x = 0.3; x < 1.2; x += 0.2) {
    // By the left one; then, with that in mind, by the right one where the left one lets go earlier.
    EXPECT_NEAR(find(-x - 0.1, -x + 0.1, -apart), on_circle(-x, -apart), 0.1 * kExact) << x;
    ASSERT_GT(on_circle(x, apart), on_circle(x, -apart) + 0.2);
    EXPECT_NEAR(find(x - 0.1, x + 0.1, apart), on_circle(x, apart), 0.1 * kExact) << x;
  }
}

// Two limits side by side with a strip of reachable surface between them. Each chord finds its own limit.
TEST(LimitFollower, DoesNotGoOverToALimitBeside) {
  const double limit = Bosses(20, 5, {0.0}).limit;
  int found = 0;
  for (const double strip : {0.2, 0.6, 1.0}) {
    const double apart = limit + 0.5 * strip;
    const Bosses bosses(30, 5, {-apart, apart});
    LimitFollower follower(bosses.reach, bosses.surface.pieces[0], kExact);
    for (const double chord : {0.1, 0.3, 1.0, 2.0}) {
      for (const double side : {-1.0, 1.0}) {
        const double angle = std::asin(0.5 * chord / limit);
        const auto end = [&](double way) {
          const double a = way * angle;
          return bosses.Place(side * (apart - limit * std::cos(a)), limit * std::sin(a));
        };
        const ZeroSegment between{end(-1.0), end(1.0)};
        const Vec2 way = between.to - between.from, across(-way.y(), way.x());
        const auto share = follower.Find(between, across, -1.0, 1.0);
        if (!share) continue;  // queried in another way
        ++found;
        const Vec2 q = 0.5 * (between.from + between.to) + *share * across;
        EXPECT_NEAR(bosses.InMm(q).x(), side * 0.5 * strip, kExact) << strip << " " << chord;
      }
    }
  }
  EXPECT_GE(found, 20);  // of 24
}

}  // namespace
}  // namespace patchmill
