// Connection formulas and basis patch method: vectors of [joining, section 8].
#include "core/joining/basis_strip.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/curve/curve.h"
#include "tests/support/json.h"
#include "tests/support/random.h"

namespace patchmill {
namespace {

using testing::Json;
using testing::LoadJson;
using testing::Random;

#define VECTORS PATCHMILL_SOURCE_DIR "/tests/vectors/"

std::vector<Vec3> Points(const Json& list) {
  std::vector<Vec3> points;
  for (const Json& p : list.Items()) points.push_back(p.Vector());
  return points;
}
std::array<double, 3> Three(const Json& list) {
  return {list[0].Number(), list[1].Number(), list[2].Number()};
}
void ExpectPoints(const auto& made, const Json& wanted, double sign = 1.0) {
  ASSERT_EQ(made.size(), wanted.Items().size());
  for (std::size_t i = 0; i < made.size(); ++i) {
    EXPECT_LE((sign * made[i] - wanted[static_cast<int>(i)].Vector()).norm(), 1e-12) << i;
  }
}

TEST(ConnectRows, Vector) {
  const Json data = LoadJson(VECTORS "g2_connection.json");
  const ConnectedRows rows =
      ConnectRows({Three(data["k"]), Three(data["l"])}, Points(data["ap"]), Points(data["Ap"]));
  const int n = static_cast<int>(data["n"].Number());
  EXPECT_EQ(static_cast<int>(rows.b.size()), n + 1);
  ExpectPoints(rows.b, data["b"]);
  ExpectPoints(rows.B, data["B"]);
  // The control points beside the edge, as differences: c, d of one row further, a and A raised to degree n.
  const BezierCurve a = Elevated(BezierCurve{Points(data["ap"])}, n),
                    A = Elevated(BezierCurve{Points(data["Ap"])}, n);
  ExpectPoints(a.points, data["a"]);
  ExpectPoints(A.points, data["A"]);
  for (int i = 0; i <= n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    EXPECT_LE((a.points[k] - A.points[k] - data["c"][i].Vector()).norm(), 1e-12) << i;
    EXPECT_LE((rows.b[k] + rows.B[k] - data["d"][i].Vector()).norm(), 1e-12) << i;
  }
}

// b = k a and B = k^2 A + l a as functions, at places between the coefficients, for every degree.
TEST(ConnectRows, AreTheProductsAsFunctions) {
  Random random(3);
  for (const int n : {5, 6, 7, 9}) {
    std::vector<Vec3> a, A;
    for (int i = 0; i <= n - 2; ++i) a.push_back(random.Point(-1, 1));
    for (int i = 0; i <= n - 4; ++i) A.push_back(random.Point(-1, 1));
    const ConnectionFactors f{{1.3, 0.9, 0.7}, {0.2, -0.4, 0.5}};
    const ConnectedRows rows = ConnectRows(f, a, A);
    for (const double v : {0.0, 0.11, 0.5, 0.83, 1.0}) {
      const auto quadratic = [v](const std::array<double, 3>& q) {
        return (1 - v) * (1 - v) * q[0] + 2 * v * (1 - v) * q[1] + v * v * q[2];
      };
      const double k = quadratic(f.k), l = quadratic(f.l);
      const Vec3 av = Evaluate(BezierCurve{a}, v).p, Av = Evaluate(BezierCurve{A}, v).p;
      EXPECT_LE((Evaluate(BezierCurve{rows.b}, v).p - k * av).norm(), 1e-14);
      EXPECT_LE((Evaluate(BezierCurve{rows.B}, v).p - (k * k * Av + l * av)).norm(), 1e-14);
    }
  }
}

struct Sides {
  const Json data = LoadJson(VECTORS "basis_patch.json");
  Vec3 At(const char* key) const { return data[key].Vector(); }
  // Into patch A: against the crossing direction. Into B: along it.
  ControlVectors a0{-At("p0"), At("p0") - At("r0")}, a1{-At("p1"), At("p1") - At("r1")};
  ControlVectors b0{At("q0"), At("s0") - At("q0")}, b1{At("q1"), At("s1") - At("q1")};
  ControlVectors am{-At("T0"), At("C0")}, bm{At("T1"), At("C1")};
  StripPlace Place(const ControlVectors& a, const ControlVectors& b) const {
    return {(b.first - a.first).normalized(), 0.5 * (BendOf(a) + BendOf(b))};
  }
  BasisStrip strip = MakeBasisStrip(Place(a0, b0), Place(am, bm), Place(a1, b1));
};

TEST(BasisStrip, Vector) {
  const Sides s;
  ExpectPoints(s.strip.a, s.data["a"]);
  ExpectPoints(s.strip.A, s.data["A"]);
  const auto fa = FactorsFor(s.strip, s.a0, s.am, s.a1), fb = FactorsFor(s.strip, s.b0, s.bm, s.b1);
  ASSERT_TRUE(fa && fb);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(-fa->k[i], Three(s.data["kA"])[i], 1e-12);
    EXPECT_NEAR(fa->l[i], Three(s.data["lA"])[i], 1e-12);
    EXPECT_NEAR(fb->k[i], Three(s.data["kB"])[i], 1e-12);
    EXPECT_NEAR(fb->l[i], Three(s.data["lB"])[i], 1e-12);
  }
  const CrossRows a = Connect(s.strip, *fa), b = Connect(s.strip, *fb);
  ExpectPoints(a.first, s.data["bA"], -1.0);
  ExpectPoints(a.second, s.data["BA"]);
  ExpectPoints(b.first, s.data["bB"]);
  ExpectPoints(b.second, s.data["BB"]);
}

// A middle vector far shorter than those of the ends makes k(v) dip below zero: refused, just above it not.
TEST(FactorsFor, RefusesAFold) {
  const Vec3 x(1, 0, 0);
  const StripPlace place{x, Vec3::Zero()};
  const BasisStrip strip = MakeBasisStrip(place, place, place);
  const auto with = [&](double start, double middle, double end) {
    return FactorsFor(strip, {start * x, Vec3::Zero()}, {middle * x, Vec3::Zero()}, {end * x, Vec3::Zero()});
  };
  // k = k0 (1-v)^2 + 2 k1 v (1-v) + k2 v^2 touches zero when k1 = -sqrt(k0 k2): k(1/2) = (k0 + k2 - 2 sqrt(k0
  // k2))/4.
  const double touch = (1 + 4 - 2 * 2) / 4.0;
  EXPECT_TRUE(with(1, touch + 1e-9, 4));
  EXPECT_FALSE(with(1, touch - 1e-9, 4));
  EXPECT_TRUE(with(-1, -touch - 1e-9, -4));
  EXPECT_FALSE(with(-1, -touch + 1e-9, -4));
  EXPECT_FALSE(with(1, 1, -1));
  EXPECT_FALSE(with(1, 1, 0));
}

}  // namespace
}  // namespace patchmill
