// Figures of unreachable regions: the tool that would reach a region and its deepest leftover, against closed
// forms and grids of places.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "cam/limits/reach_tolerance.h"
#include "cam/location/limits/operation_limits.h"
#include "cam/region/reach/reach.h"
#include "cam/region/split_regions.h"
#include "core/diffgeo/forms.h"
#include "core/surface/closest.h"
#include "tests/support/deepest_leftover.h"
#include "tests/support/files.h"
#include "tests/support/sanitized.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

constexpr double kR = 3.0;

RegionParams Params() {
  RegionParams params;
  params.radius = kR;
  params.tolerance = 0.01;
  return params;
}

RegionMap Split(const Surface& surface, const RegionParams& params) {
  auto map = SplitRegions(surface, params, RunContext());
  EXPECT_TRUE(map.ok()) << map.status();
  return map.ok() ? *std::move(map) : RegionMap();
}

struct Part {
  std::string file;
  double scale;
};

// Y of the file is up.
Surface Upright(const std::string& file, double scale) {
  Eigen::Affine3d upright = Eigen::Affine3d::Identity();
  upright.rotate(Eigen::AngleAxisd(Radians(90.0), Vec3::UnitX())).scale(scale);
  return SurfaceOf(Transformed(LoadModel(file), upright));
}

int Count(const RegionMap& map, UnreachableReason reason) {
  return static_cast<int>(std::count_if(map.regions.begin(), map.regions.end(), [&](const Region& r) {
    return r.kind == RegionKind::kUnreachable && r.reason == reason;
  }));
}

double TotalArea(const RegionMap& map) {
  double area = 0.0;
  for (const Region& r : map.regions) area += r.area;
  return area;
}

// The stated leftover occurs at some place, and no place has a twentieth more.
void ExpectDeepest(const Region& r, double stays) {
  EXPECT_LE(r.deepest_leftover, stays + 0.01 * kR);
  EXPECT_GE(r.deepest_leftover, stays / 1.05 - 0.002 * kR - ReachTolerance(Params().tolerance));
}

TEST(RegionFigures, NoToolReachesACrease) {
  // Two planes of 45 degrees: at their crease only the tolerance lets a ball in.
  const double a = Radians(45.0);
  const RegionMap map = Split(SurfaceOf(TwoPlanes(a, 20)), Params());
  ASSERT_EQ(Count(map, UnreachableReason::kConcave), 1);
  for (const Region& r : map.regions) {
    if (r.kind != RegionKind::kUnreachable) continue;
    EXPECT_EQ(r.largest_tool_diameter, 0.0);
    const double stays = kR / std::cos(a) - kR;
    ExpectDeepest(r, stays);
  }
}

TEST(RegionFigures, TheToolForASlotOfUprightWallsIsAsWide) {
  // 5 wide, without a bottom: a ball of 2.5 and half the tolerance enters it. On its walls no side is the
  // upper one, and behind them lies the part.
  const double half = 2.5, far = 20.0, deep = 10.0;
  const auto wall = [&](double x) {
    return Single(Bilinear({x, -far, -deep}, {x, far, -deep}, {x, -far, 0}, {x, far, 0}));
  };
  const auto top = [&](double x, double end) {
    return Single(Bilinear({x, -far, 0}, {x, far, 0}, {end, -far, 0}, {end, far, 0}));
  };
  const PatchModel slot = Join({wall(-half), top(-half, -far), wall(half), top(half, far)});
  const RegionParams params = Params();
  const RegionMap map = Split(SurfaceOf(slot), params);
  int walls = 0;
  for (const Region& r : map.regions) {
    if (r.kind != RegionKind::kUnreachable || r.reason != UnreachableReason::kConcave) continue;
    ++walls;
    EXPECT_NEAR(r.largest_tool_diameter, 2.0 * half + 2.0 * ReachTolerance(params.tolerance), 0.01);
  }
  EXPECT_EQ(walls, 2);
}

// The least radius over a grid on every piece. What is said is below it only as far as places between those
// of the grid are worse.
TEST(RegionFigures, TheToolForARegionReachesAllOfIt) {
  const Surface surface = Upright("examples/teapot.bpt", 50.0);
  const RegionParams params = Params();
  const RegionMap map = Split(surface, params);
  std::vector<double> least(map.regions.size(), kR);
  constexpr int kGrid = kSanitized ? 20 : 60;
  for (std::size_t i = 0; i < surface.pieces.size(); ++i) {
    for (int k = 0; k < kGrid * kGrid; ++k) {
      const double u = (k / kGrid + 0.5) / kGrid, v = (k % kGrid + 0.5) / kGrid;
      const SurfaceJet jet = Evaluate(surface.pieces[i], u, v);
      const std::size_t id = map.At({PieceId(i), u, v, jet.p}).index();
      const auto e = FacingAt(jet);
      if (!e || map.regions[id].kind != RegionKind::kUnreachable ||
          map.regions[id].reason != UnreachableReason::kConcave) {
        continue;
      }
      least[id] = LargestFreeRadius(surface, jet.p, *e, least[id], ReachTolerance(params.tolerance));
    }
  }
  int creases = 0, grooves = 0;
  for (std::size_t id = 0; id < map.regions.size(); ++id) {
    const Region& r = map.regions[id];
    if (r.kind != RegionKind::kUnreachable || r.reason != UnreachableReason::kConcave) continue;
    SCOPED_TRACE(id);
    if (r.largest_tool_diameter == 0.0) {
      ++creases;
      EXPECT_LT(least[id], 10.0 * params.tolerance);
    } else {
      ++grooves;
      EXPECT_LE(r.largest_tool_diameter, 2.02 * least[id]);
      EXPECT_GE(r.largest_tool_diameter, (kSanitized ? 1.8 : 1.95) * least[id]);  // by a coarser grid
    }
  }
  EXPECT_GE(creases, 2);  // where spout and handle meet the body
  EXPECT_GE(grooves, 1);  // below the lid's edge
}

TEST(RegionFigures, WhatStaysUnderASlabIsThatOfItsMiddle) {
  // A square of 24 over a plane: R beside its nearest side a ball stands on the plane. The deepest place is
  // one point of 1,000 mm2 and more.
  const double half = 12.0, high = 30.0;
  for (const double turn : {0.0, 0.4}) {
    Eigen::Affine3d placed = Eigen::Affine3d::Identity();
    placed.rotate(Eigen::AngleAxisd(turn, Vec3::UnitZ()));
    const PatchModel slab = Transformed(
        Single(Bilinear({-half, -half, high}, {half, -half, high}, {-half, half, high}, {half, half, high})),
        placed);
    const RegionParams params = Params();
    const RegionMap map = Split(SurfaceOf(Join({Plane(60), slab})), params);
    ASSERT_EQ(Count(map, UnreachableReason::kUndercut), 1);
    for (const Region& r : map.regions) {
      if (r.kind != RegionKind::kUnreachable) continue;
      const double stays = std::hypot(half + kR, kR) - kR;
      ExpectDeepest(r, stays);
    }
  }
}

// Grids of places on every piece, each with the reason of the region it lies in.
TEST(RegionFigures, NoPlaceOfARegionKeepsMoreThanIsSaid) {
  int deep = 0;
  for (const Part& part : {Part{"examples/teapot.bpt", 50.0}, Part{"tests/models/teacup.bpt", 20.0},
                           Part{"tests/models/torus_bicubic.patches", 30.0}}) {
    if (kSanitized && part.scale > 40.0) continue;
    SCOPED_TRACE(part.file);
    const Surface surface = Upright(part.file, part.scale);
    RegionParams params = Params();
    params.floor_z = surface.box.min.z();
    const RegionMap map = Split(surface, params);
    const double reach_tolerance = ReachTolerance(params.tolerance);
    const Locator free_ball(surface, kR - reach_tolerance);
    struct Places {
      std::vector<Vec3> points, normals;
    };
    std::vector<Places> places(map.regions.size());
    constexpr int kGrid = kSanitized ? 10 : 25;
    for (std::size_t i = 0; i < surface.pieces.size(); ++i) {
      for (int k = 0; k < kGrid * kGrid; ++k) {
        const double u = (k / kGrid + 0.5) / kGrid, v = (k % kGrid + 0.5) / kGrid;
        const SurfaceJet jet = Evaluate(surface.pieces[i], u, v);
        Places& of = places[map.At({PieceId(i), u, v, jet.p}).index()];
        of.points.push_back(jet.p);
        of.normals.push_back(UpwardNormal(jet).value_or(Vec3::Zero()));
      }
    }
    for (const Region& r : map.regions) {
      if (r.kind != RegionKind::kUnreachable) continue;
      SCOPED_TRACE(r.id.value);
      const Places& of = places[r.id.index()];
      LeftoverParams leftover;
      leftover.floor_z = params.floor_z;
      const Deepest found = DeepestLeftover(free_ball, leftover, of.points, RunContext(), of.normals);
      EXPECT_LE(found.leftover, 1.05 * r.deepest_leftover + 0.002 * kR) << r.area << " mm2";
      deep += found.leftover > 0.1 * kR;
    }
  }
  EXPECT_GE(deep, kSanitized ? 3 : 10);
}

TEST(RegionFigures, UnderAHighestTipTheTopOfABallStays) {
  const Surface surface = SurfaceOf(Sphere(Vec3::Zero(), 10, Half::kUpper));
  Containment containment;
  containment.top_z = 5.0;
  const auto operation_limits =
      OperationLimits::Make(surface, containment, {.ball_radius = kR, .tool_radius = kR}, RunContext());
  ASSERT_TRUE(operation_limits.ok()) << operation_limits.status();
  RegionParams params = Params();
  params.operation_limits = &*operation_limits;
  const RegionMap map = Split(surface, params);
  ASSERT_EQ(Count(map, UnreachableReason::kAvoided), 1);
  for (const Region& r : map.regions) {
    if (r.kind != RegionKind::kUnreachable) continue;
    // From the circle of centres at height 8, all of them 13 from the middle.
    const double stays = std::hypot(std::sqrt(13.0 * 13.0 - 8.0 * 8.0), 2.0) - kR;
    ExpectDeepest(r, stays);
  }
}

TEST(RegionFigures, WhereNoBallIsAllowedEverythingStays) {
  const Surface surface = SurfaceOf(Sphere(Vec3::Zero(), 10, Half::kUpper));
  Containment containment;
  containment.top_z = -5.0;
  const auto operation_limits =
      OperationLimits::Make(surface, containment, {.ball_radius = kR, .tool_radius = kR}, RunContext());
  ASSERT_TRUE(operation_limits.ok()) << operation_limits.status();
  RegionParams params = Params();
  params.operation_limits = &*operation_limits;
  params.floor_z = 0.0;
  const RegionMap map = Split(surface, params);
  ASSERT_GE(map.regions.size(), 1u);
  for (const Region& r : map.regions) {
    ASSERT_EQ(r.kind, RegionKind::kUnreachable);
    EXPECT_DOUBLE_EQ(r.deepest_leftover, surface.box.Diagonal());
  }
}

// The raw split, slivers and all.
TEST(RegionFigures, UnmergedRegionsHaveAreasAndPointsOfTheirOwn) {
  for (const Part& part :
       {Part{"examples/teapot.bpt", 50.0}, Part{"tests/models/teacup.bpt", 20.0},
        Part{"tests/models/icosahedron.patches", 30.0}, Part{"tests/models/toroidal_tet.patches", 40.0},
        Part{"tests/models/torus_bicubic.patches", 30.0}}) {
    if (kSanitized && part.scale > 40.0) continue;
    SCOPED_TRACE(part.file);
    const Surface surface = Upright(part.file, part.scale);
    RegionParams params = Params();
    const double all = TotalArea(Split(surface, params));
    params.detail = 1.0;
    const RegionMap map = Split(surface, params);
    EXPECT_NEAR(TotalArea(map), all, 1e-6 * all);
    std::vector<bool> has_cells(map.regions.size(), false);
    for (const std::vector<RegionId>& labels : map.labels)
      for (const RegionId id : labels) has_cells[id.index()] = true;
    int without = 0;
    for (const Region& r : map.regions) {
      SCOPED_TRACE(r.id.value);
      EXPECT_GT(r.area, 0.0);
      const std::size_t id = r.id.index();
      without += !has_cells[id];
      const auto found = ClosestToPoint(surface, r.inside, 1.0, 1e-6);
      ASSERT_TRUE(found);
      constexpr double kSliver = 0.01;  // mm2, along a seam: a point of it may be its neighbour's as well
      if (!has_cells[id] || r.area < kSliver) continue;
      EXPECT_EQ(map.At(found->at), r.id) << r.area << " mm2";
    }
    EXPECT_LE(20 * without, static_cast<int>(map.regions.size()));
  }
}

}  // namespace
}  // namespace patchmill
