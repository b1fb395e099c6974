// Carriers against the surfaces' own formulas, and feet of places beside them.
#include "core/trim/carrier_grid.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/brep_parts.h"

namespace patchmill {
namespace {

using testing::TiltedFrame;

struct Case {
  const char* name;
  BrepSurface surface;
  Vec2 low, high;
  std::function<Vec3(double, double)> formula;
};

std::vector<Case> Cases() {
  const BrepFrame f = TiltedFrame();
  const auto ring = [f](double u, double r, double h) {
    return Vec3(f.origin + r * (std::cos(u) * f.x + std::sin(u) * f.y) + h * f.z);
  };
  const double a = 0.4;
  return {
      {"plane",
       BrepPlane{f},
       {-2, 1},
       {5, 4},
       [f](double u, double v) { return Vec3(f.origin + u * f.x + v * f.y); }},
      {"cylinder",
       BrepCylinder{f, 6},
       {0.3, -2},
       {5.9, 9},
       [=](double u, double v) { return ring(u, 6, v); }},
      {"cone",
       BrepCone{f, 4, a},
       {-1.0, 0},
       {2.0, 5},
       [=](double u, double v) { return ring(u, 4 + v * std::sin(a), v * std::cos(a)); }},
      {"sphere",
       BrepSphere{f, 5},
       {0, -kPi / 2},
       {2 * kPi, kPi / 2},
       [=](double u, double v) { return ring(u, 5 * std::cos(v), 5 * std::sin(v)); }},
      {"torus",
       BrepTorus{f, 9, 2},
       {0, 0},
       {2 * kPi, 2 * kPi},
       [=](double u, double v) { return ring(u, 9 + 2 * std::cos(v), 2 * std::sin(v)); }},
  };
}

TEST(CarrierGrid, PlacesAreThoseOfTheFormulas) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (const Case& c : Cases()) {
    const CarrierGrid grid = CarriersOf(c.surface, c.low, c.high);
    for (int k = 0; k < 200; ++k) {
      const Vec2 at(c.low.x() + (c.high.x() - c.low.x()) * unit(random),
                    c.low.y() + (c.high.y() - c.low.y()) * unit(random));
      const Vec3 expected = c.formula(at.x(), at.y());
      EXPECT_LT((PositionAt(grid, GridCoordinates(grid, at)) - expected).norm(), 1e-12) << c.name;
    }
  }
}

TEST(CarrierGrid, FeetFromFarAwayStarts) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (const Case& c : Cases()) {
    const CarrierGrid grid = CarriersOf(c.surface, c.low, c.high);
    for (int k = 0; k < 200; ++k) {
      const Vec2 at((0.1 + 0.8 * unit(random)) * grid.u.count(), (0.1 + 0.8 * unit(random)) * grid.v.count());
      const Vec2 start = (at + 0.3 * Vec2(unit(random) - 0.5, unit(random) - 0.5)).cwiseMax(0.0);
      const GridCell cell = CellAt(grid, at);
      const SurfaceJet jet = JetAt(grid, cell, at);
      const Vec3 normal = jet.du.cross(jet.dv).normalized();
      const double off = 0.4 * (unit(random) - 0.5);
      const auto foot =
          FootOnGrid(grid, jet.p + off * normal, start.cwiseMin(Vec2(grid.u.count(), grid.v.count())));
      ASSERT_TRUE(foot) << c.name;
      EXPECT_NEAR(foot->distance, std::abs(off), 1e-12) << c.name;
      EXPECT_LT((foot->point - jet.p).norm(), 1e-10) << c.name;
    }
  }
}

// x = u^2, y = u + v: both parameters run along y on the side u = 0.
TEST(CarrierGrid, FeetOnASideWithoutAParametrisation) {
  BrepSpline spline;
  spline.patch = {2, 1, {0, 0, 0, 1, 1, 1}, {0, 0, 1, 1}, {}, {}};
  for (const Vec2& at : {Vec2(0, 0), Vec2(0, 0.5), Vec2(1, 1)}) {
    for (const double v : {0.0, 1.0}) spline.patch.points.emplace_back(30 * at.x(), 30 * (at.y() + v), 0);
  }
  const CarrierGrid grid = CarriersOf(spline, {0, 0}, {1, 1});
  for (int k = 0; k <= 20; ++k) {
    const double v = 0.05 + 0.045 * k;
    for (const double u : {0.0, 0.02, 0.2}) {
      const Vec3 place = PositionAt(grid, {0.0, v});
      const auto foot = FootOnGrid(grid, place, {u, std::max(0.0, v - u)});
      ASSERT_TRUE(foot) << v << " " << u;
      EXPECT_LE(foot->distance, 1e-9) << v << " " << u;
    }
  }
}

// An arc, and a radius that begins in the same point like t^2: in the corner neither parameter moves
// the place.
TEST(CarrierGrid, FeetInACornerWithoutAnyDirection) {
  BrepSpline spline;
  const double w = std::sqrt(0.5);
  spline.patch = {2, 1, {0, 0, 0, 1, 1, 1}, {0, 0, 1, 1}, {}, {1, 1, w, w, 1, 1}};
  spline.patch.points = {{8, 0, 0}, {8, 0, 0}, {8, 8, 0}, {8, 0, 0}, {0, 8, 0}, {0, 0, 0}};
  const CarrierGrid grid = CarriersOf(spline, {0, 0}, {1, 1});
  for (const double x : {8.0, 8.0 - 1e-9, 8.0 - 1e-5, 7.9, 4.0, 0.0}) {
    for (const double u : {0.0, 0.01, 0.3, 1.0}) {
      const auto foot = FootOnGrid(grid, {x, 0, 0}, {u, 1.0});
      ASSERT_TRUE(foot) << x << " " << u;
      EXPECT_LE(foot->distance, 1e-11) << x << " " << u;
    }
  }
}

// A strip ten million times as long as it is wide, far from the origin: only its length counts.
TEST(CarrierGrid, FeetOnNeedles) {
  for (const double width : {1e-2, 1e-4, 1e-6}) {
    BrepSpline spline;
    spline.patch = {2, 1, {0, 0, 0, 1, 1, 1}, {0, 0, 1, 1}, {}, {}};
    const Vec3 origin(120, -70, 90);
    for (const double x : {0.0, 15.0, 30.0}) {
      for (const double v : {0.0, 1.0})
        spline.patch.points.push_back(origin + Vec3(x, v * width, x == 15.0 ? 4.0 : 0.0));
    }
    const CarrierGrid grid = CarriersOf(spline, {0, 0}, {1, 1});
    for (int k = 0; k <= 20; ++k) {
      const Vec2 at(0.05 * k, k % 3 == 0 ? 0.0 : 0.37);
      const Vec3 place = PositionAt(grid, at);
      const auto foot = FootOnGrid(grid, place, {std::min(1.0, at.x() + 0.02), 1.0});
      ASSERT_TRUE(foot) << width << " " << k;
      EXPECT_LE(foot->distance, 1e-12) << width << " " << k;
      EXPECT_NEAR(foot->at.x(), at.x(), 1e-12) << width << " " << k;
    }
  }
}

TEST(CarrierGrid, AConeEndsAtItsApex) {
  const BrepCone cone{TiltedFrame(), 4, 0.4};
  const double apex = -4 / std::sin(0.4);
  const CarrierGrid grid = CarriersOf(cone, {0, apex}, {kPi, 3});
  const Vec3 tip = PositionAt(grid, {0.3, 0.0});
  EXPECT_LT((PositionAt(grid, {1.9, 0.0}) - tip).norm(), 1e-13);
  EXPECT_LT((tip - (TiltedFrame().origin + apex * std::cos(0.4) * TiltedFrame().z)).norm(), 1e-12);
}

}  // namespace
}  // namespace patchmill
