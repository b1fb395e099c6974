// Roots of fields on a segment, awkward values included.
#include "core/lines/zero_root.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

double Root(const std::function<double(double)>& f) {
  const Surface surface = SurfaceOf(Plane(1));  // x = 2 u - 1
  ZeroField field;
  field.value = [&](const SurfaceJet& jet) { return f(0.5 * (jet.p.x() + 1.0)); };
  return ZeroBetween(field, surface.pieces[0], {{0, 0.5}, {1, 0.5}, f(0.0), f(1.0)}, 1e-13);
}

TEST(ZeroRoot, SmoothFields) {
  EXPECT_NEAR(Root([](double t) { return t - 0.3; }), 0.3, 1e-12);
  EXPECT_NEAR(Root([](double t) { return std::cos(t) - 0.9; }), std::acos(0.9), 1e-12);
  EXPECT_NEAR(Root([](double t) { return std::pow(t, 9) - 1e-6; }), std::pow(1e-6, 1.0 / 9.0), 1e-12);
  EXPECT_NEAR(Root([](double t) { return t < 0.7 ? -1.0 : 20.0; }), 0.7, 1e-12);
}

// Curvatures are infinite, or no number, where the parametrisation has no normal.
TEST(ZeroRoot, InfiniteAndMissingValues) {
  for (const double odd : {HUGE_VAL, -HUGE_VAL, std::nan("")}) {
    const double sign = odd > 0.0 ? 1.0 : -1.0;
    EXPECT_NEAR(Root([&](double t) { return t == 0.0 ? odd : sign * (0.4 - t); }), 0.4, 1e-12) << odd;
    EXPECT_NEAR(Root([&](double t) { return t == 1.0 ? odd : sign * (t - 0.4); }), 0.4, 1e-12) << odd;
    EXPECT_NEAR(Root([&](double t) { return t < 0.25 ? odd : sign * (0.4 - t); }), 0.4, 1e-12) << odd;
  }
}

}  // namespace
}  // namespace patchmill
