// Bulges against what [shapes (40), (41)] promise.
#include "core/patch/bulge.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/network/control_points.h"
#include "core/network/patch_model.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using testing::Random;

TEST(Bulge, IsHighestAtItsPlaceOnly) {
  for (const double at_u : {0.01, 0.2, 0.5, 0.93}) {
    for (const double at_v : {0.01, 0.8, 0.5, 0.99}) {
      const Jet2 top = BulgeWeight(at_u, at_v, at_u, at_v);
      EXPECT_EQ(top.f, 1.0);
      EXPECT_NEAR(top.u, 0.0, 1e-12);
      EXPECT_NEAR(top.v, 0.0, 1e-12);
      EXPECT_LT(top.uu, 0.0);
      EXPECT_LT(top.vv, 0.0);
      double before = 0.0;
      for (int k = 0; k <= 1000; ++k) {  // each factor rises up to the place and falls after it
        const double u = 0.001 * k, f = BulgeWeight(at_u, at_v, u, at_v).f;
        if (u <= at_u) {
          EXPECT_GE(f, before) << u;
        }
        if (u - 0.001 >= at_u) {
          EXPECT_LE(f, before) << u;
        }
        EXPECT_GE(f, 0.0);
        before = f;
      }
    }
  }
}

TEST(Bulge, LeavesTheBorderToSecondOrder) {
  for (const double t : {0.0, 0.3, 1.0}) {
    for (const Jet2& j : {BulgeWeight(0.2, 0.8, t, 0.0), BulgeWeight(0.2, 0.8, t, 1.0),
                          BulgeWeight(0.2, 0.8, 0.0, t), BulgeWeight(0.2, 0.8, 1.0, t)}) {
      for (const double x : {j.f, j.u, j.v, j.uu, j.uv, j.vv}) EXPECT_NEAR(x, 0.0, 1e-13);
    }
  }
}

TEST(Bulge, HasContinuousSecondDerivatives) {
  constexpr double kStep = 1e-9;
  for (const double at : {0.05, 0.3, 0.5, 0.77}) {
    const Jet2 below = BulgeWeight(at, 0.4, at - kStep, 0.3), above = BulgeWeight(at, 0.4, at + kStep, 0.3);
    EXPECT_NEAR(below.uu, above.uu, 1e-4 * std::abs(below.uu));
    EXPECT_NEAR(below.uv, above.uv, 1e-5);
  }
}

TEST(Bulge, InTheMiddleHasTheClosedForm) {
  // At 1/2 both sides are the quintic with the coefficients 0 0 0 1/2 1 1.
  for (const double x : {0.1, 0.4, 0.9}) {
    const double y = 1.0 - x;
    const double f = 5.0 * x * x * x * y * y + 5.0 * x * x * x * x * y + x * x * x * x * x;
    EXPECT_NEAR(BulgeWeight(0.5, 0.5, 0.5 * x, 0.5).f, f, 1e-15);
    EXPECT_NEAR(BulgeWeight(0.5, 0.5, 1.0 - 0.5 * x, 0.5).f, f, 1e-15);
  }
}

TEST(Bulge, MovesEveryPlaceAlongItsVector) {
  for (const PatchShape& bulged : testing::BulgedKinds(1.0)) {
    PatchShape plain = bulged;
    std::visit(
        [](auto& s) {
          if constexpr (requires { s.bulges; }) s.bulges.clear();
        },
        plain);
    Random random(1);
    for (int k = 0; k < 30; ++k) {
      const double u = random.Unit(), v = random.Unit();
      Vec3 wanted = Position(plain, u, v);
      for (const Bulge& b : Bulges(bulged)) wanted += BulgeWeight(b.u, b.v, u, v).f * b.by;
      EXPECT_LE((Position(bulged, u, v) - wanted).norm(), 1e-15);
      EXPECT_LE((Evaluate(bulged, u, v).p - wanted).norm(), 1e-14);
    }
  }
}

TEST(Bulge, IsPlacedAsAVector) {
  Placement placement;
  placement.scale = 2.0;
  placement.up = UpAxis::kX;
  placement.translation = Vec3(5, 6, 7);
  for (const PatchShape& shape : testing::BulgedKinds(1.0)) {
    const PatchModel placed = Place(placement, testing::Single(shape));
    EXPECT_LE(
        (Position(placed.patches[0].shape, 0.3, 0.7) - Place(placement, Position(shape, 0.3, 0.7))).norm(),
        1e-13);
  }
}

TEST(Bulge, OutsideItsLimitsIsRefused) {
  const PatchShape sound = testing::BulgedKinds(1.0)[1];
  EXPECT_TRUE(ValidateModel(testing::Single(sound)).empty());
  const auto refused = [&](const auto& change) {
    PatchShape shape = sound;
    change(std::get<GregoryPatch>(shape).bulges);
    const Diagnostics faults = ValidateModel(testing::Single(shape));
    return faults.size() == 1 && faults[0].code == "INVALID_BULGE" &&
           faults[0].where.field == "patches[0].bulges";
  };
  EXPECT_TRUE(refused([](auto& b) { b[0].u = 0.0; }));
  EXPECT_TRUE(refused([](auto& b) { b[0].v = std::nan(""); }));
  EXPECT_TRUE(refused([](auto& b) { b[1].by.z() = std::nan(""); }));
  EXPECT_TRUE(refused([](auto& b) { b.resize(kMaxBulges + 1, b[0]); }));
}

}  // namespace
}  // namespace patchmill
