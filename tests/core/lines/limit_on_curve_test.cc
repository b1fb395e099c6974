// Where a limit known by signs alone crosses a curve.
#include "core/lines/limit_on_curve.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

constexpr double kResolution = 1e-9;  // mm

// v = 0.3 + u^2 / 2 on the plane piece x = 2 u - 1, y = 2 v - 1.
ZeroField Parabola() {
  ZeroField field;
  field.value = [](const SurfaceJet& jet) {
    const double u = 0.5 * (jet.p.x() + 1.0), v = 0.5 * (jet.p.y() + 1.0);
    return v - 0.3 - 0.5 * u * u;
  };
  return field;
}

// Negative (or positive) within a circle around the corner u = v = 0; its limits by halving.
ZeroField Circle(double radius, double within) {
  ZeroField field;
  field.smooth = false;
  field.value = [=](const SurfaceJet& jet) {
    const double u = 0.5 * (jet.p.x() + 1.0), v = 0.5 * (jet.p.y() + 1.0);
    return u * u + v * v < radius * radius ? within : -within;
  };
  field.limits = [value = field.value](const Piece& piece, std::span<const ZeroSegment> segments,
                                       std::span<double> limits) {
    for (std::size_t k = 0; k < segments.size(); ++k) {
      double low = 0.0, high = 1.0;
      const Vec2 way = segments[k].to - segments[k].from;
      while ((high - low) * 2.0 * way.norm() > kResolution) {
        const double middle = 0.5 * (low + high);
        const Vec2 q = segments[k].from + middle * way;
        (value(Evaluate(piece, q.x(), q.y())) < 0.0 ? low : high) = middle;
      }
      limits[k] = 0.5 * (low + high);
    }
  };
  return field;
}

// u where the parabola leaves the circle.
double CrossingOf(double radius) {
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double u = 0.5 * (low + high), v = 0.3 + 0.5 * u * u;
    (u * u + v * v < radius * radius ? low : high) = u;
  }
  return low;
}

TEST(LimitOnCurve, IsOnBothFromWhereverAChordIs) {
  const Surface surface = SurfaceOf(Plane(1));
  for (const double radius : {0.4, 0.55, 0.7, 0.9}) {
    const double u = CrossingOf(radius);
    const Vec2 crossing(u, 0.3 + 0.5 * u * u);
    for (const double within : {-1.0, 1.0}) {
      for (const Vec2& off : {Vec2(0.0, 0.0), Vec2(1e-7, -1e-7), Vec2(2e-4, 1e-4), Vec2(-0.01, 0.02)}) {
        const auto found =
            LimitOnCurve(Parabola(), Circle(radius, within), surface.pieces[0], crossing + off, 0.1);
        ASSERT_TRUE(found) << radius << " " << off.transpose();
        EXPECT_LT((*found - crossing).norm(), 2.0 * kResolution) << radius << " " << off.transpose();
        EXPECT_LT(std::abs(found->y() - 0.3 - 0.5 * found->x() * found->x()), 1e-12);
      }
    }
  }
}

TEST(LimitOnCurve, IsNothingOutOfReachOrBeyondThePiece) {
  const Surface surface = SurfaceOf(Plane(1));
  const double u = CrossingOf(0.55);
  const Vec2 crossing(u, 0.3 + 0.5 * u * u);
  const ZeroField circle = Circle(0.55, -1.0);
  EXPECT_FALSE(LimitOnCurve(Parabola(), circle, surface.pieces[0], crossing + Vec2(0.05, 0.0), 0.02));
  EXPECT_FALSE(LimitOnCurve(Parabola(), Circle(3.0, -1.0), surface.pieces[0], crossing, 0.2));
  EXPECT_FALSE(LimitOnCurve(Parabola(), Circle(0.25, -1.0), surface.pieces[0], {0.0, 0.3}, 0.1));
  ZeroField nowhere = Parabola();
  nowhere.value = [](const SurfaceJet&) { return 1.0; };
  EXPECT_FALSE(LimitOnCurve(nowhere, circle, surface.pieces[0], crossing, 0.1));
}

}  // namespace
}  // namespace patchmill
