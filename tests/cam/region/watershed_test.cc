// Mountains of several summits and basins of several pits, divided along their watersheds.
#include <cmath>

#include <gtest/gtest.h>

#include "cam/region/region_map.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

RegionMap Split(const Surface& surface, RegionParams params = {}) {
  auto map = SplitRegions(surface, params, RunContext());
  EXPECT_TRUE(map.ok()) << map.status();
  return *std::move(map);
}

std::vector<Region> Of(const RegionMap& map, RegionKind kind) {
  std::vector<Region> found;
  for (const Region& r : map.regions) {
    if (r.kind == kind) found.push_back(r);
  }
  return found;
}

double Area(const Surface& surface) {
  double area = 0.0;
  constexpr int n = 200;
  for (const Piece& piece : surface.pieces) {
    const int m = surface.pieces.size() > 20 ? 12 : n;
    for (int i = 0; i < m; ++i) {
      for (int j = 0; j < m; ++j) {
        const SurfaceJet jet = Evaluate(piece, (i + 0.5) / m, (j + 0.5) / m);
        area += jet.du.cross(jet.dv).norm() / (m * m);
      }
    }
  }
  return area;
}

// Two equal hills at (-a, 0) and (a, 0), their summits 2 a apart.
Surface Twins(double a, double height, double sign = 1.0) {
  const auto hill = [=](double x, double y) { return std::exp(-(x * x + y * y) / 60); };
  const auto both = [=](double x, double y) { return sign * height * (hill(x - a, y) + hill(x + a, y)); };
  return SurfaceOf(Single(InterpolatedHeights(both, -24, 24, -16, 16, 16, 10)));
}

TEST(Watershed, TwinHillsAreDividedByTheirPlaneOfSymmetry) {
  for (const double sign : {1.0, -1.0}) {
    const Surface surface = Twins(10, 6, sign);
    RegionParams params;
    params.radius = 1.5;
    params.border_tolerance = 1e-4;
    const RegionMap map = Split(surface, params);
    const auto hills = Of(map, sign > 0 ? RegionKind::kMountain : RegionKind::kBasin);
    ASSERT_EQ(hills.size(), 2u) << sign;
    EXPECT_NEAR(hills[0].area, hills[1].area, 1e-4 * hills[0].area);
    EXPECT_LT(hills[0].inside.x() * hills[1].inside.x(), 0.0);
    double total = 0.0;
    for (const Region& r : map.regions) total += r.area;
    EXPECT_NEAR(total, Area(surface), 1e-5 * total);
    // Where both have a border inside the sheet and below the pass, it lies on the plane.
    int on_plane = 0;
    for (const Region& r : hills) {
      for (const auto& loop : r.border) {
        for (const Vec3& p : loop) {
          EXPECT_GE(p.x() * r.inside.x(), -1e-3 * std::abs(r.inside.x())) << p.transpose();
          on_plane += std::abs(p.x()) < 1e-3;
        }
      }
    }
    EXPECT_GT(on_plane, 10);
  }
}

// z = -y^2 / 50 + c cos(pi x / 10): summits every 20 mm, passes 2 c below them.
TEST(Watershed, WhatStandsOutTooLittleIsNoMountainOfItsOwn) {
  for (const double c : {0.1, 0.2, 0.4}) {
    const auto ridge = [=](double x, double y) { return c * std::cos(kPi * x / 10) - y * y / 50; };
    const Surface surface = SurfaceOf(Single(InterpolatedHeights(ridge, -30, 30, -10, 10, 30, 6)));
    const RegionMap map = Split(surface);             // 0.1 of the radius: 0.3 mm
    const std::size_t summits = 2 * c > 0.3 ? 3 : 1;  // at -20, 0 and 20
    EXPECT_EQ(Of(map, RegionKind::kMountain).size(), summits) << c;
    RegionParams coarse;
    coarse.detail = 0.1;  // 9 times as much
    EXPECT_EQ(Of(Split(surface, coarse), RegionKind::kMountain).size(), 1u) << c;
  }
}

TEST(Watershed, ACraterRimOfTwoSummitsIsCutAtBothPasses) {
  // A rim of radius 12, highest at angles 0 and pi by 2 mm: two passes, at pi / 2 and 3 pi / 2.
  const auto crater = [](double x, double y) {
    const double r = std::hypot(x, y), c = r > 1e-9 ? x / r : 1.0;
    const double ring = (r - 12) / 5;
    return (6 + 1.5 * (2 * c * c - 1) * std::tanh(r * r / 144)) * std::exp(-ring * ring) - r * r / 400;
  };
  const Surface surface = SurfaceOf(Single(InterpolatedHeights(crater, -26, 26, -26, 26, 30, 30)));
  RegionParams params;
  params.radius = 2.0;
  const RegionMap map = Split(surface, params);
  // Outside, mountains fall to both sides of the plane x = 0, none lies on both.
  const auto mountains = Of(map, RegionKind::kMountain);
  ASSERT_GE(mountains.size(), 2u);
  for (const Region& r : mountains) {
    double low = 0.0, high = 0.0;
    for (const auto& loop : r.border) {
      for (const Vec3& p : loop) {
        low = std::min(low, p.x());
        high = std::max(high, p.x());
      }
    }
    EXPECT_LT(std::min(-low, high), 0.5) << r.id;
  }
}

TEST(Watershed, OneHillStaysWhole) {
  const auto hill = [](double x, double y) { return 8 * std::exp(-(x * x + y * y) / 80); };
  const Surface surface = SurfaceOf(Single(InterpolatedHeights(hill, -15, 15, -15, 15, 14, 14)));
  EXPECT_EQ(Of(Split(surface), RegionKind::kMountain).size(), 1u);
}

}  // namespace
}  // namespace patchmill
