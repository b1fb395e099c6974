// Derivatives of every kind against central differences of order eight, natively and as pieces.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/patch/piece.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using testing::Random;

constexpr double kStep = 0.001;
constexpr double kReach = 4 * kStep;

// f'(t) of a vector function; error about step^8 f^(9) / 630 + 1e-16 |f| / step.
template <class F>
Vec3 Difference(F f, double t) {
  constexpr double kWeight[4] = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
  Vec3 sum = Vec3::Zero();
  for (int k = 1; k <= 4; ++k) sum += kWeight[k - 1] * (f(t + k * kStep) - f(t - k * kStep));
  return sum / kStep;
}

template <class Jet>  // jet(u, v) -> SurfaceJet
void ExpectDerivatives(Jet jet, double u, double v) {
  const SurfaceJet s = jet(u, v);
  const auto near = [&](const Vec3& a, const Vec3& b, const char* what) {
    EXPECT_LE((a - b).norm(), 1e-10 * (1 + b.norm())) << what << " at " << u << ", " << v;
  };
  near(Difference([&](double t) { return jet(t, v).p; }, u), s.du, "du");
  near(Difference([&](double t) { return jet(u, t).p; }, v), s.dv, "dv");
  near(Difference([&](double t) { return jet(t, v).du; }, u), s.duu, "duu");
  near(Difference([&](double t) { return jet(u, t).du; }, v), s.duv, "duv");
  near(Difference([&](double t) { return jet(t, v).dv; }, u), s.duv, "dvu");
  near(Difference([&](double t) { return jet(u, t).dv; }, v), s.dvv, "dvv");
}

void ExpectDerivatives(const PatchShape& shape, bool smooth_inside = true) {
  Random random(3);
  const auto native = [&](double u, double v) { return Evaluate(shape, u, v); };
  for (int k = 0; smooth_inside && k < 40; ++k) {
    double u = random.Uniform(0.1, 0.9), v = random.Uniform(0.1, 0.9);
    if (IsTriangle(shape)) v *= 0.9 - u;
    ExpectDerivatives(native, u, v);
  }
  for (const Piece& piece : SplitIntoPieces(PatchId(0), shape)) {
    const auto own = [&](double u, double v) { return Evaluate(piece, u, v); };
    for (int k = 0; k < 10; ++k) ExpectDerivatives(own, random.Uniform(0.1, 0.9), random.Uniform(0.1, 0.9));
  }
}

TEST(Derivatives, Bezier) {
  for (const bool rational : {false, true}) {
    for (int p = 1; p <= kMaxDegree; ++p) {
      ExpectDerivatives(testing::RandomBezier(p, p, 1 + (p * 7) % 15, rational, 1.0));
      ExpectDerivatives(testing::RandomBezier(p, p, p, rational, 1.0));
    }
  }
}

TEST(Derivatives, BsplinePieces) {
  for (const bool rational : {false, true}) {
    for (int p = 1; p <= 5; ++p) ExpectDerivatives(testing::RandomKnots(p, p, 6 - p, rational, 1.0), false);
  }
}

TEST(Derivatives, BsplineNativelyInsideSpans) {
  Random random(4);
  for (const bool rational : {false, true}) {
    const PatchShape shape =
        testing::RandomBspline(5, {.size = 1.0, .amplitude = 0.2, .rational = rational}).patches[0].shape;
    int done = 0;
    for (int k = 0; k < 200; ++k) {
      const double u = random.Uniform(0.05, 0.95), v = random.Uniform(0.05, 0.95);
      const auto clear = [](double t) {
        return std::abs(6 * t - std::round(6 * t)) > 6 * kReach;
      };  // of the knots
      if (!clear(u) || !clear(v)) continue;
      ExpectDerivatives([&](double a, double b) { return Evaluate(shape, a, b); }, u, v);
      ++done;
    }
    EXPECT_GT(done, 50);
  }
}

TEST(Derivatives, Gregory) {
  for (const auto blend : {GregoryPatch::Blend::kCorner, GregoryPatch::Blend::kEdge}) {
    for (int seed = 0; seed < 5; ++seed) ExpectDerivatives(testing::RandomGregory(seed, blend, 1.0));
  }
}

TEST(Derivatives, Triangles) {
  for (const bool rational : {false, true}) {
    for (int n = 1; n <= kMaxDegree; ++n) ExpectDerivatives(testing::RandomTriangle(n, n, rational, 1.0));
  }
}

TEST(Derivatives, BlendedKinds) {
  for (const PatchShape& shape : testing::SingularKinds(1.0)) ExpectDerivatives(shape);
}

TEST(Derivatives, BrownChains) {
  ExpectDerivatives(testing::RandomBrown(6, 4, 3, 1.0, {0.3, 0.5}, {0.6}), false);
}

TEST(Derivatives, Hosaka) {
  for (const int n : {1, 3, 6}) ExpectDerivatives(testing::RandomHosaka(n, n, false, n == 6, 1.0));
  ExpectDerivatives(testing::RandomHosaka(9, 3, true, true, 1.0), false);
}

TEST(Derivatives, Bulges) {
  for (const PatchShape& shape : testing::BulgedKinds(1.0)) ExpectDerivatives(shape, false);
}

}  // namespace
}  // namespace patchmill
