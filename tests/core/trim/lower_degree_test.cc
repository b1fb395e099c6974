// Splines of high degree against their lowered ones, at the same parameters.
#include "core/trim/lower_degree.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/index.h"

namespace patchmill {
namespace {

// Two by three spans of the degrees over 60 x 40 mm, waving by 4 mm, with weights from 1 to `weight`.
BsplinePatch Wavy(int p, int q, double weight) {
  std::mt19937 random(static_cast<unsigned>(100 * p + q));
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  BsplinePatch patch;
  patch.degree_u = p;
  patch.degree_v = q;
  const auto knots = [](int degree, const std::vector<double>& inner) {
    std::vector<double> list(At(degree + 1), 0.0);
    list.insert(list.end(), inner.begin(), inner.end());
    list.insert(list.end(), At(degree + 1), 1.0);
    return list;
  };
  patch.knots_u = knots(p, {0.4});
  patch.knots_v = knots(q, {0.3, 0.8});
  for (int i = 0; i <= p + 1; ++i) {
    for (int j = 0; j <= q + 2; ++j) {
      patch.points.push_back({60.0 * i / (p + 1), 40.0 * j / (q + 2), 4.0 * unit(random)});
      if (weight != 1.0) patch.weights.push_back(1.0 + (weight - 1.0) * unit(random));
    }
  }
  return patch;
}

double LargestDistance(const CarrierGrid& a, const CarrierGrid& b) {
  double most = 0.0;
  for (int i = 0; i <= 60; ++i) {
    for (int j = 0; j <= 60; ++j) {
      const Vec2 at(i / 60.0, j / 60.0);
      most = std::max(most,
                      (PositionAt(a, GridCoordinates(a, at)) - PositionAt(b, GridCoordinates(b, at))).norm());
    }
  }
  return most;
}

TEST(LowerDegree, SurfacesStayWithinTheStatedError) {
  struct Degrees {
    int p, q;
  };
  for (const Degrees d : {Degrees{2, 14}, {14, 2}, {6, 13}, {8, 8}, {15, 15}}) {
    for (const double weight : {1.0, 1.8}) {
      const CarrierGrid grid = CarriersOf(BrepSpline{Wavy(d.p, d.q, weight)}, {0, 0}, {1, 1});
      double last = kInfinity;
      for (const double tolerance : {1e-2, 1e-5}) {
        const auto lowered = WithLowerDegrees(grid, tolerance);
        ASSERT_TRUE(lowered.ok()) << lowered.status();
        EXPECT_LE(lowered->error, tolerance);
        EXPECT_LE(LargestDistance(grid, lowered->grid), lowered->error + 1e-12)
            << d.p << " " << d.q << " " << weight;
        EXPECT_LT(lowered->error, last);
        last = lowered->error;
        for (const Piece& piece : lowered->grid.carriers) {
          EXPECT_EQ(piece.net.degree_u, std::min(d.p, kLoweredDegree));
          EXPECT_EQ(piece.net.degree_v, std::min(d.q, kLoweredDegree));
        }
      }
    }
  }
}

// Neighbours have the same side to the last bits, so no gap opens between their patches.
TEST(LowerDegree, NeighboursStillMeet) {
  const auto lowered = WithLowerDegrees(CarriersOf(BrepSpline{Wavy(9, 14, 1.5)}, {0, 0}, {1, 1}), 1e-4);
  ASSERT_TRUE(lowered.ok()) << lowered.status();
  const CarrierGrid& grid = lowered->grid;
  ASSERT_GT(grid.u.count(), 2);
  ASSERT_GT(grid.v.count(), 3);
  for (int i = 0; i < grid.u.count(); ++i) {
    for (int j = 0; j < grid.v.count(); ++j) {
      for (const double t : {0.0, 0.3, 1.0}) {
        if (i > 0) {
          EXPECT_LT((Position(grid.carrier(i - 1, j), 1.0, t) - Position(grid.carrier(i, j), 0.0, t)).norm(),
                    1e-12);
        }
        if (j > 0) {
          EXPECT_LT((Position(grid.carrier(i, j - 1), t, 1.0) - Position(grid.carrier(i, j), t, 0.0)).norm(),
                    1e-12);
        }
      }
    }
  }
}

// A polynomial of degree 5 that is written in the degree 12 comes back: its knots stay, and nothing is
// halved.
TEST(LowerDegree, WhatHasTheLowDegreeIsFound) {
  BsplinePatch patch = Wavy(3, 5, 1.0);
  patch.knots_v = {0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1};
  patch.points.clear();
  for (int i = 0; i <= 4; ++i) {
    for (int j = 0; j <= 5; ++j) patch.points.push_back({15.0 * i, 8.0 * j, std::sin(i + 2.0 * j)});
  }
  BsplinePatch high = patch;
  for (int degree = 5; degree < 12; ++degree) {
    BsplinePatch raised = high;
    raised.degree_v = degree + 1;
    raised.knots_v.assign(At(degree + 2), 0.0);
    raised.knots_v.insert(raised.knots_v.end(), At(degree + 2), 1.0);
    raised.points.clear();
    for (int i = 0; i <= 4; ++i) {
      for (int j = 0; j <= degree + 1; ++j) {
        const double t = static_cast<double>(j) / (degree + 1);
        const auto at = [&](int k) { return high.points[At(i * (degree + 1) + std::clamp(k, 0, degree))]; };
        raised.points.push_back(t * at(j - 1) + (1.0 - t) * at(j));
      }
    }
    high = raised;
  }
  const CarrierGrid low = CarriersOf(BrepSpline{patch}, {0, 0}, {1, 1});
  const auto lowered = WithLowerDegrees(CarriersOf(BrepSpline{high}, {0, 0}, {1, 1}), 1e-9);
  ASSERT_TRUE(lowered.ok()) << lowered.status();
  EXPECT_EQ(lowered->grid.v.breaks, low.v.breaks);
  EXPECT_LT(LargestDistance(low, lowered->grid), 1e-12);
}

}  // namespace
}  // namespace patchmill
