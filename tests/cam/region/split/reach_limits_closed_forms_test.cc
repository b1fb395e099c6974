// Limits of reach under overhangs: their places, the areas that they bound, and the nodes at which other
// lines end on them, against closed forms. On surfaces without a closed form they are checked by balls on
// both sides.
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "cam/limits/reach_tolerance.h"
#include "cam/region/reach/reach.h"
#include "cam/region/split_regions.h"
#include "core/diffgeo/forms.h"
#include "core/surface/closest.h"
#include "tests/support/sanitized.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

constexpr double kR = 3.0, kTolerance = 0.01,
                 kKept = kR - ReachTolerance(kTolerance);  // of the shank's axis from an edge
constexpr double kHigh = 40.0;

RegionParams Exact() {
  RegionParams p;
  p.radius = kR;
  p.tolerance = kTolerance;
  p.detail = 1.0;
  p.border_tolerance = 1e-7;
  p.floor_z = -1000.0;
  return p;
}

RegionMap Split(const PatchModel& model) {
  const Surface surface = SurfaceOf(model);
  auto map = SplitRegions(surface, Exact(), RunContext());
  EXPECT_TRUE(map.ok()) << map.status();
  return *std::move(map);
}

// A level slab of half sizes `hx` and `hy`, high above the plate.
PatchModel Slab(const Vec2& middle, double hx, double hy) {
  const auto at = [&](double x, double y) { return Vec3(middle.x() + x, middle.y() + y, kHigh); };
  return Single(Bilinear(at(-hx, -hy), at(hx, -hy), at(-hx, hy), at(hx, hy)));
}

// The node of the map nearest to a place.
double ToNode(const RegionMap& map, const Vec3& p) {
  double least = kInfinity;
  for (const Vec3& node : map.nodes) least = std::min(least, (node - p).norm());
  return least;
}

TEST(ReachBorders, UnderASlabIsARoundedRectangle) {
  const double half = 30.0, hx = 9.0, hy = 6.0;
  const RegionMap map = Split(Join({Plane(half), Slab({2, 1}, hx, hy)}));
  const double under = 4 * hx * hy + 4 * (hx + hy) * kKept + kPi * kKept * kKept;
  double unreachable = 0.0;
  for (const Region& region : map.regions)
    unreachable += region.kind == RegionKind::kUnreachable ? region.area : 0.0;
  EXPECT_NEAR(unreachable, under, 1e-6 * under);
  double length = 0.0;
  for (const BorderLine& line : map.border_lines) {
    if (line.kind != BorderKind::kReach) continue;
    const auto reachable = [&](RegionId id) {
      return map.regions[id.index()].kind != RegionKind::kUnreachable;
    };
    // Lines between two reasons lie within.
    const bool limit = reachable(line.region) || reachable(line.other);
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      const Vec3& p = line.points[i];
      const Vec2 beside = ((Xy(p) - Vec2(2, 1)).cwiseAbs() - Vec2(hx, hy)).cwiseMax(0.0);
      EXPECT_LE(beside.norm(), kKept + 1e-6);
      if (!limit) continue;
      EXPECT_GE(beside.norm(), kKept - 1e-6) << p.transpose();
      if (i + 1 < line.points.size() || line.closed)
        length += (line.points[(i + 1) % line.points.size()] - p).norm();
    }
  }
  EXPECT_NEAR(length, 4 * (hx + hy) + 2 * kPi * kKept, 1e-5);
}

TEST(ReachBorders, TheSlopeLinesOfACylinderEndOnThem) {
  const double r = 10.0;
  const RegionMap map = Split(Join({Cylinder(Vec3::Zero(), r, 40.0, Half::kUpper), Slab({0, -50}, 40, 50)}));
  // Its axis is y; slopes of 45 degrees are at x = +-r sin 45, the slab ends at y = 0.
  for (const double side : {-1.0, 1.0}) {
    const double s = std::sqrt(0.5);
    EXPECT_LT(ToNode(map, Vec3(side * r * s, kKept, r * s)), 2e-7);
  }
}

TEST(ReachBorders, TheInflectionsOfASaddleEndOnThem) {
  const double a = 0.02, b = 0.03, ratio = std::sqrt(a / b);
  const auto height = [=](double x, double y) { return a * x * x - b * y * y; };
  const RegionMap map =
      Split(Join({Single(InterpolatedHeights(height, -15, 15, -15, 15, 4, 4)), Slab({-50, 0}, 50, 60)}));
  // Along y = +-ratio x the centre is as far from the slab, which ends at x = 0, as it must be at one place.
  const auto center_x = [&](double x) {
    return x - kR * 2 * a * x / std::sqrt(1 + 4 * a * a * x * x + 4 * b * b * ratio * ratio * x * x);
  };
  double low = 0.0, high = 10.0;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (center_x(middle) < kKept ? low : high) = middle;
  }
  for (const double side : {-1.0, 1.0}) {
    const double y = side * ratio * low;
    EXPECT_LT(ToNode(map, Vec3(low, y, height(low, y))), 2e-7);
  }
}

// Of a surface, whether the ball that touches it nearest to a place is free.
class FreeBeside {
 public:
  FreeBeside(const Surface& surface, const RegionParams& params)
      : surface_(surface),
        ball_(surface, params.radius - ReachTolerance(params.tolerance)),
        reach_(ball_, params, RunContext()) {}
  bool operator()(const Vec3& near) const {
    const auto at = ClosestToPoint(surface_, near, 1.0, 1e-5);
    if (!at) return false;
    const SurfaceJet jet = Evaluate(surface_, at->at.piece, at->at.u, at->at.v);
    const auto facing = FacingAt(jet);
    return facing && reach_.Free(jet.p, *facing);
  }

 private:
  const Surface& surface_;
  const Locator ball_;
  const ReachTest reach_;
};

constexpr double kOff = 0.02;  // mm

// Two bosses whose limits come within a mm of each other: each is a circle, and none goes over to the other.
TEST(ReachBorders, OfTwoBossesSideBySideAreTwoCircles) {
  const double half = 30.0, r = 2.0, reached = r + kKept;
  const double limit = std::sqrt(reached * reached - kR * kR);
  for (const Vec2& c : {Vec2(0.0912, 4.3865), Vec2(0.5167, 4.2562), Vec2(4.2, 0.3)}) {
    const auto boss = [&](double side) { return Sphere(side * Vec3(c.x(), c.y(), 0.0), r, Half::kUpper); };
    const Surface surface = SurfaceOf(Join({Plane(half), boss(1.0), boss(-1.0)}));
    RegionParams params = Exact();
    params.border_tolerance = 0.01;
    const auto map = SplitRegions(surface, params, RunContext());
    ASSERT_TRUE(map.ok()) << map.status();
    double length = 0.0;
    for (const BorderLine& line : map->border_lines) {
      if (line.kind != BorderKind::kReach) continue;
      for (std::size_t i = 0; i + (line.closed ? 0 : 1) < line.points.size(); ++i) {
        const Vec3 &a = line.points[i], &b = line.points[(i + 1) % line.points.size()];
        if (std::max(a.z(), b.z()) > 1e-6) continue;  // on a boss
        const Vec2 middle = Xy(0.5 * (a + b));
        if (std::min((middle - c).norm(), (middle + c).norm()) < r) continue;  // under one, UNDERCUT begins
        length += (b - a).norm();
        EXPECT_NEAR(std::min((middle - c).norm(), (middle + c).norm()), limit, 0.0201) << middle.transpose();
      }
    }
    EXPECT_NEAR(length, 4 * kPi * limit, 0.1);
  }
}

// A cap on a plate. Beside the crease the plate is CONCAVE, under the cap UNDERCUT. The size of the plate's
// patch, and with it the size of the cells, does not matter.
TEST(ReachBorders, ReasonsBesideACreaseAreTheSameOnPlatesOfAnySize) {
  const double cap = 30.0, low = 20.0;
  const double outer2 = std::pow(cap + kKept, 2) - std::pow(kR + low, 2);  // where the ball begins to be free
  const double foot2 = cap * cap - low * low;
  std::map<UnreachableReason, double> first;
  for (const double half : {30.0, 60.0, 150.0}) {
    const Surface surface = SurfaceOf(Join({Plane(half), Sphere(Vec3(0, 0, -low), cap, Half::kUpper)}));
    RegionParams params;
    params.radius = kR;
    params.tolerance = kTolerance;
    const auto map = SplitRegions(surface, params, RunContext());
    ASSERT_TRUE(map.ok()) << map.status();
    std::map<UnreachableReason, double> plate;
    for (const Region& r : map->regions) {
      if (r.kind == RegionKind::kUnreachable && std::abs(r.inside.z()) < 1e-9) plate[r.reason] += r.area;
    }
    const double undercut = plate[UnreachableReason::kUndercut], concave = plate[UnreachableReason::kConcave];
    EXPECT_NEAR(undercut + concave, kPi * outer2, 1.5) << half;
    EXPECT_NEAR(undercut, kPi * foot2, 0.01 * kPi * foot2) << half;
    if (first.empty()) first = plate;
    EXPECT_NEAR(undercut, first[UnreachableReason::kUndercut], 1.0) << half;
    EXPECT_NEAR(concave, first[UnreachableReason::kConcave], 1.0) << half;
  }
}

// Surfaces without a closed form that bend tighter than the ball nearly everywhere. All but a few hundredths
// of the limits drawn lie where balls begin to be free. The rest are corners at which one obstacle takes
// over from another within a cell.
TEST(ReachBorders, OfAnySurfaceAreWhereBallsBeginToBeFree) {
  if (kSanitized) GTEST_SKIP() << "minutes otherwise";
  const Surface surface = SurfaceOf(Bumpy());
  const RegionParams params;
  const auto map = SplitRegions(surface, params, RunContext());
  ASSERT_TRUE(map.ok()) << map.status();
  const FreeBeside free(surface, params);
  double length = 0.0, off = 0.0;
  for (const BorderLine& line : map->border_lines) {
    if (line.kind != BorderKind::kReach) continue;
    for (std::size_t i = 0; i + (line.closed ? 0 : 1) < line.points.size(); ++i) {
      const Vec3 &a = line.points[i], &b = line.points[(i + 1) % line.points.size()];
      if ((b - a).norm() < 1e-9) continue;
      const auto at = ClosestToPoint(surface, 0.5 * (a + b), 1.0, 1e-5);
      ASSERT_TRUE(at);
      const auto normal = UpwardNormal(Evaluate(surface, at->at.piece, at->at.u, at->at.v));
      ASSERT_TRUE(normal);
      const Vec3 across = kOff * normal->cross(b - a).normalized();
      length += (b - a).norm();
      if (free(at->at.p + across) == free(at->at.p - across)) off += (b - a).norm();
    }
  }
  EXPECT_GT(length, 3000.0);
  EXPECT_LT(off, 0.015 * length);
}

// Lines of slope or curvature end at limits of reach. Close to such a node, balls that are free touch the
// surface, and balls that are not.
TEST(ReachBorders, NodesOfAnySurfaceAreOnThem) {
  if (kSanitized) GTEST_SKIP() << "minutes otherwise";
  const Surface surface = SurfaceOf(Bumpy());
  RegionParams params;
  params.detail = 1.0;
  const auto map = SplitRegions(surface, params, RunContext());
  ASSERT_TRUE(map.ok()) << map.status();
  const FreeBeside free(surface, params);
  std::vector<bool> of_reach(map->nodes.size(), false), of_curve = of_reach;
  for (const BorderLine& line : map->border_lines) {
    for (const int node : {line.from, line.to}) {
      if (node < 0) continue;
      if (line.kind == BorderKind::kReach) of_reach[static_cast<std::size_t>(node)] = true;
      if (line.kind == BorderKind::kSlope || line.kind == BorderKind::kCurvature)
        of_curve[static_cast<std::size_t>(node)] = true;
    }
  }
  int nodes = 0, off = 0;
  for (std::size_t i = 0; i < map->nodes.size(); ++i) {
    if (!of_reach[i] || !of_curve[i]) continue;
    const auto at = ClosestToPoint(surface, map->nodes[i], 1.0, 1e-5);
    ASSERT_TRUE(at);
    const auto normal = UpwardNormal(Evaluate(surface, at->at.piece, at->at.u, at->at.v));
    ASSERT_TRUE(normal);
    const Vec3 one = normal->unitOrthogonal(), other = normal->cross(one);
    bool seen[2] = {false, false};
    for (int k = 0; k < 16; ++k) {
      const double angle = kPi * k / 8.0;
      seen[free(at->at.p + kOff * (std::cos(angle) * one + std::sin(angle) * other))] = true;
    }
    ++nodes;
    off += !(seen[0] && seen[1]);
  }
  EXPECT_GT(nodes, 500);
  EXPECT_LT(off, 0.02 * nodes) << off << " of " << nodes;
}

}  // namespace
}  // namespace patchmill
