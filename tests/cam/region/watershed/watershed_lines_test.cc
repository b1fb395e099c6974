// Mountains of several summits and basins of several pits, divided along their watersheds.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "cam/region/split_regions.h"
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
    EXPECT_LT(std::min(-low, high), 0.5) << r.id.value;
  }
}

// z = f(x) + g(y) on [x0, x1] x [y0, y1] as one patch; polynomials by their coefficients, constants first.
struct Sum {
  std::vector<double> f, g;
  double x0, x1, y0, y1;
};

std::vector<double> Bernstein(const std::vector<double>& monomials, double a, double b) {
  const std::size_t n = monomials.size() - 1;
  const auto choose = [](std::size_t m, std::size_t k) {
    double c = 1.0;
    for (std::size_t i = 0; i < k; ++i) c *= static_cast<double>(m - i) / static_cast<double>(i + 1);
    return c;
  };
  std::vector<double> scaled(n + 1, 0.0), c(n + 1, 0.0);  // in t of [0, 1]
  for (std::size_t k = 0; k <= n; ++k) {
    for (std::size_t i = 0; i <= k; ++i) {
      scaled[i] += monomials[k] * choose(k, i) * std::pow(b - a, static_cast<double>(i)) *
                   std::pow(a, static_cast<double>(k - i));
    }
  }
  for (std::size_t i = 0; i <= n; ++i) {
    for (std::size_t k = 0; k <= i; ++k) c[i] += choose(i, k) / choose(n, k) * scaled[k];
  }
  return c;
}

Surface SurfaceOfSum(const Sum& sum, bool reverse = false) {
  const std::vector<double> f = Bernstein(sum.f, sum.x0, sum.x1), g = Bernstein(sum.g, sum.y0, sum.y1);
  BezierPatch patch;
  patch.degree_u = static_cast<int>(f.size()) - 1;
  patch.degree_v = static_cast<int>(g.size()) - 1;
  for (std::size_t k = 0; k < f.size(); ++k) {
    const std::size_t i = reverse ? f.size() - 1 - k : k;
    for (std::size_t j = 0; j < g.size(); ++j) {
      const double u = static_cast<double>(i) / patch.degree_u, v = static_cast<double>(j) / patch.degree_v;
      patch.points.emplace_back(sum.x0 + u * (sum.x1 - sum.x0), sum.y0 + v * (sum.y1 - sum.y0), f[i] + g[j]);
    }
  }
  return SurfaceOf(Single(patch));
}

// Where contours turn on z = k / 2 (x^2 - y^2) are the two lines y = x and y = -x of the plane z = 0, however
// gently it bends: at 1 m of radius all values of the field are tiny for centimetres around the saddle.
TEST(Watershed, GentleSaddlesAreNodes) {
  const double cx = 3.3, cy = -2.1, half = 30.0;
  for (const double k : {0.1, 0.03, 0.015, 0.005, 0.001}) {
    for (const bool reverse : {false, true}) {
      const Surface surface = SurfaceOfSum({{0.5 * k * cx * cx, -k * cx, 0.5 * k},
                                            {-0.5 * k * cy * cy, k * cy, -0.5 * k},
                                            -half,
                                            half,
                                            -half,
                                            half},
                                           reverse);
      RegionParams params;
      params.detail = 1.0;
      params.steep_angle = Radians(80.0);
      const RegionMap map = Split(surface, params);
      EXPECT_EQ(Of(map, RegionKind::kMountain).size(), 2u) << k << reverse;
      EXPECT_EQ(Of(map, RegionKind::kBasin).size(), 2u) << k << reverse;
      double nearest = kInfinity, length = 0.0;
      for (const Vec3& node : map.nodes) nearest = std::min(nearest, (node - Vec3(cx, cy, 0.0)).norm());
      EXPECT_LE(nearest, 1e-9) << k << reverse;
      for (const BorderLine& line : map.border_lines) {
        if (line.kind != BorderKind::kCurvature) continue;
        for (std::size_t i = 1; i < line.points.size(); ++i) {
          const Vec3 &a = line.points[i - 1], &b = line.points[i];
          length += (b - a).norm();
          const double x = std::abs(b.x() - cx), y = std::abs(b.y() - cy);
          EXPECT_LE(std::abs(x - y), 0.02) << k << reverse << " " << b.transpose();
        }
      }
      // Each ray ends at the nearer side of the square.
      double rays = 0.0;
      for (const double sx : {-1.0, 1.0})
        for (const double sy : {-1.0, 1.0}) rays += std::sqrt(2.0) * std::min(half - sx * cx, half - sy * cy);
      EXPECT_NEAR(length, rays, 0.05) << k << reverse;
    }
  }
}

// Two hills of a quartic, two pits of another, the saddle off the middle of the patch: divided by the plane x
// = 0.
TEST(Watershed, PlainHillsAndPits) {
  for (const double sign : {1.0, -1.0}) {
    for (const double scale : {0.1, 1.0, 10.0}) {
      const double c = sign * 6e-5 / (scale * scale * scale), d = sign * 0.01 / scale,
                   a2 = 100.0 * scale * scale;
      for (const bool reverse : {false, true}) {
        const Surface surface = SurfaceOfSum({{-c * a2 * a2, 0.0, 2.0 * c * a2, 0.0, -c},
                                              {0.0, 0.0, -d},
                                              -15.0 * scale,
                                              16.3 * scale,
                                              -10.0 * scale,
                                              11.7 * scale},
                                             reverse);
        RegionParams params;
        params.radius = 3.0 * scale;
        params.tolerance = 0.01 * scale;
        params.border_tolerance = 0.01 * scale;
        const RegionMap map = Split(surface, params);
        const auto hills = Of(map, sign > 0.0 ? RegionKind::kMountain : RegionKind::kBasin);
        ASSERT_EQ(hills.size(), 2u) << sign << " " << scale << reverse;
        double left = 0.0, all = 0.0;
        constexpr int n = 400;
        for (int i = 0; i < n; ++i) {
          for (int j = 0; j < n; ++j) {
            const SurfaceJet jet = Evaluate(surface.pieces[0], (i + 0.5) / n, (j + 0.5) / n);
            const double area = jet.du.cross(jet.dv).norm() / (n * n);
            all += area;
            const double span = 31.3 * scale / n, share = std::clamp(0.5 - jet.p.x() / span, 0.0, 1.0);
            left += share * area;
          }
        }
        EXPECT_NEAR(hills[0].area, std::max(left, all - left), 2e-4 * all) << sign << " " << scale << reverse;
        EXPECT_NEAR(hills[1].area, std::min(left, all - left), 2e-4 * all) << sign << " " << scale << reverse;
      }
    }
  }
}

TEST(Watershed, OneHillStaysWhole) {
  const auto hill = [](double x, double y) { return 8 * std::exp(-(x * x + y * y) / 80); };
  const Surface surface = SurfaceOf(Single(InterpolatedHeights(hill, -15, 15, -15, 15, 14, 14)));
  EXPECT_EQ(Of(Split(surface), RegionKind::kMountain).size(), 1u);
}

}  // namespace
}  // namespace patchmill
