#include "core/patch/condition_pieces.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/patch/piece.h"
#include "tests/support/eigen_matchers.h"
#include "tests/support/hard_parts.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using testing::IsNear;
using testing::Random;

// Weights from 2^-range to 2^range.
template <class Patch>
Patch Reweighted(Patch patch, double range, Random& random) {
  patch.weights.assign(patch.points.size(), 1.0);
  for (double& w : patch.weights) w = std::exp2(random.Uniform(-range, range));
  return patch;
}

// The largest range of the binary logarithms of the weights along a line of the net.
double LargestRange(const BernsteinNet& net) {
  const int row = net.degree_v + 1;
  double largest = 0.0;
  const auto log_weight = [&](int i, int j) {
    return std::log2(net.points[static_cast<std::size_t>(i * row + j)].w());
  };
  for (int i = 0; i <= net.degree_u; ++i) {
    for (int j = 0; j <= net.degree_v; ++j) {
      for (int k = 0; k <= net.degree_u; ++k)
        largest = std::max(largest, log_weight(i, j) - log_weight(k, j));
      for (int k = 0; k <= net.degree_v; ++k)
        largest = std::max(largest, log_weight(i, j) - log_weight(i, k));
    }
  }
  return largest;
}

void ExpectSamePoints(const PatchShape& shape, const std::vector<Piece>& pieces, Random& random) {
  double area = 0.0;
  for (const Piece& piece : pieces) {
    EXPECT_LT(LargestRange(piece.net), internal::kEvenWeights);
    const Vec2 diagonal = piece.native[3] - piece.native[0];
    area += diagonal.x() * diagonal.y();
    for (int k = 0; k < 8; ++k) {
      const double u = random.Unit(), v = random.Unit();
      const Vec2 native = NativeParameters(piece, u, v);
      const Vec3 p = Position(piece, u, v), same = Position(shape, native.x(), native.y());
      // Native parameters are exact to 1e-16 only, and the shape may run very fast there.
      const SurfaceJet jet = Evaluate(shape, native.x(), native.y());
      EXPECT_THAT(p, IsNear(same, 1e-12 + 1e-14 * (jet.du.norm() + jet.dv.norm())));
    }
  }
  EXPECT_NEAR(area, 1.0, 1e-12);
}

TEST(ConditionPieces, KeepThePointsOfAnyWeights) {
  for (int seed = 1; seed <= 40; ++seed) {
    Random random(static_cast<std::uint64_t>(seed));
    const int p = 1 + random.Int(4), q = 1 + random.Int(4);
    const double range = random.Uniform(1.0, 20.0);
    const PatchShape bezier =
        Reweighted(testing::RandomBezier(static_cast<std::uint64_t>(seed), p, q, false), range, random);
    ExpectSamePoints(bezier, SplitIntoPieces(PatchId(0), bezier), random);
    const PatchShape spline =
        Reweighted(testing::RandomKnots(static_cast<std::uint64_t>(seed), p, q, false), 0.5 * range, random);
    ExpectSamePoints(spline, SplitIntoPieces(PatchId(0), spline), random);
  }
}

// Weights of 1e-6 to 1e6 that are those of a plain sphere times a^i b^j: only factors, no cut.
TEST(ConditionPieces, KnowASphereInOtherParameters) {
  for (const double ratio : {1e2, 1e6, 1e12}) {
    const PatchShape plain = testing::WeightedOctant(1.0).patches[0].shape;
    const PatchShape shape = testing::WeightedOctant(ratio).patches[0].shape;
    const std::vector<Piece> even = SplitIntoPieces(PatchId(0), plain);
    const std::vector<Piece> pieces = SplitIntoPieces(PatchId(0), shape);
    ASSERT_EQ(pieces.size(), 1u);
    EXPECT_LT(LargestRange(pieces[0].net), LargestRange(even[0].net) + 2.0) << ratio;
    for (const double u : {0.0, 0.3, 0.5, 1.0}) {
      EXPECT_NEAR(Position(pieces[0], u, 0.7).norm(), 30.0, 1e-12);
      EXPECT_NEAR(Position(pieces[0], 0.2, u).norm(), 30.0, 1e-12);
    }
  }
}

TEST(ConditionPieces, LeaveEvenWeightsAlone) {
  for (int seed = 1; seed <= 10; ++seed) {
    const PatchShape shape = testing::RandomBezier(static_cast<std::uint64_t>(seed), 3, 4, true);
    const std::vector<Piece> pieces = SplitIntoPieces(PatchId(0), shape);
    ASSERT_EQ(pieces.size(), 1u);
    EXPECT_EQ(pieces[0].speed, Vec2(1.0, 1.0));
    const BezierPatch& patch = std::get<BezierPatch>(shape);
    for (std::size_t k = 0; k < patch.points.size(); ++k)
      EXPECT_EQ(pieces[0].net.points[k].w(), patch.weights[k]);
  }
}

TEST(Eased, IsUndoneByTheInverseSpeed) {
  for (const double speed : {1e-12, 1e-3, 1.0, 7.0, 1e9}) {
    EXPECT_EQ(Eased(0.0, speed), 0.0);
    EXPECT_EQ(Eased(1.0, speed), 1.0);
    const double digits = 1e-15 * std::max(speed, 1.0 / speed);  // what rounding near the other end leaves
    for (const double t : {0.1, 0.5, 0.9}) EXPECT_NEAR(Eased(Eased(t, speed), 1.0 / speed), t, 4.0 * digits);
    constexpr double kStep = 1e-15;
    EXPECT_NEAR(Eased(kStep, speed) / kStep / speed, 1.0, 1e-5);
  }
}

}  // namespace
}  // namespace patchmill
