#include "core/math/jet2.h"

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace patchmill {
namespace {

using testing::Random;

Jet2 Any(Random& r) {
  Jet2 a;
  for (double* x : {&a.f, &a.u, &a.v, &a.uu, &a.uv, &a.vv}) *x = r.Uniform(-2, 2);
  return a;
}

void ExpectEqual(const Jet2& a, const Jet2& b, double tolerance) {
  EXPECT_NEAR(a.f, b.f, tolerance);
  EXPECT_NEAR(a.u, b.u, tolerance);
  EXPECT_NEAR(a.v, b.v, tolerance);
  EXPECT_NEAR(a.uu, b.uu, tolerance);
  EXPECT_NEAR(a.uv, b.uv, tolerance);
  EXPECT_NEAR(a.vv, b.vv, tolerance);
}

TEST(Jet2, IsAField) {
  Random r(1);
  for (int k = 0; k < 100; ++k) {
    const Jet2 a = Any(r), b = Any(r), c = Any(r);
    Jet2 d = Any(r);
    d.f = 1.5 + d.f * d.f;
    ExpectEqual(a * (b + c), a * b + a * c, 1e-13);
    ExpectEqual((a * b) * c, a * (b * c), 1e-12);
    ExpectEqual((a / d) * d, a, 1e-12);
    ExpectEqual(a - b + b, a, 1e-14);
    ExpectEqual(-a, Jet2::Constant(0) - a, 0);
    ExpectEqual(2.5 * a, Jet2::Constant(2.5) * a, 1e-14);
  }
}

TEST(Jet2, KnowsPartialDerivatives) {
  // f = u^2 v / (1 + v): the classical derivatives.
  const double u = 0.7, v = 0.4, w = 1 / (1 + v);
  const Jet2 ju = Jet2::U(u), jv = Jet2::V(v);
  const Jet2 f = ju * ju * jv / (Jet2::Constant(1) + jv);
  ExpectEqual(f,
              {u * u * v * w, 2 * u * v * w, u * u * w * w, 2 * v * w, 2 * u * w * w, -2 * u * u * w * w * w},
              1e-15);
}

}  // namespace
}  // namespace patchmill
