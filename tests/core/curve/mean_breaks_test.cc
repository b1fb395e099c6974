#include "core/curve/mean_breaks.h"

#include <gtest/gtest.h>

#include "core/base/index.h"
#include "core/curve/spline.h"

namespace patchmill {
namespace {

std::vector<Vec3> Arch(double x, double height, double bias, int count) {
  std::vector<Vec3> points;
  for (int k = 0; k < count; ++k) {
    const double t = k / (count - 1.0), s = t + bias * t * (1 - t);
    points.emplace_back(x, 40 * s, height * 4 * s * (1 - s));
  }
  return points;
}

// The natural spline through points in the chord parameter.
BezierChain Through(const std::vector<Vec3>& points) {
  std::vector<double> spans;
  BezierChain chain{3, {0.0}, {points.front()}};
  for (std::size_t k = 1; k < points.size(); ++k) {
    spans.push_back((points[k] - points[k - 1]).norm());
    chain.breaks.push_back(chain.breaks.back() + spans.back());
  }
  const double length = chain.breaks.back();
  for (double& at : chain.breaks) at /= length;
  for (const HermiteCurve& span : SplineOver(points, spans)) {
    const std::vector<Vec3> bezier = ToBezier(span).points;
    chain.points.insert(chain.points.end(), bezier.begin() + 1, bezier.end());
  }
  return chain;
}

TEST(MeanBreaks, SectionsKeepTheirPointsAndEndsAndShareTheirBreaks) {
  std::vector<BezierChain> chains;
  for (int k = 0; k < 4; ++k) chains.push_back(Through(Arch(10 * k, 8 + 3 * k, 0.1 * k, 9)));
  const auto made = WithMeanBreaks(chains);
  ASSERT_TRUE(made.ok()) << made.status();
  ASSERT_EQ(made->size(), 4u);
  for (std::size_t c = 0; c < 4; ++c) {
    const BezierChain& chain = (*made)[c];
    EXPECT_EQ(chain.breaks, (*made)[0].breaks);
    double mean = 0.0;
    for (const BezierChain& old : chains) mean += 0.25 * old.breaks[3];
    EXPECT_NEAR(chain.breaks[3], mean, 1e-15);
    for (int k = 0; k < 9; ++k) {
      EXPECT_LE(
          (chain.points[static_cast<std::size_t>(3 * k)] - chains[c].points[static_cast<std::size_t>(3 * k)])
              .norm(),
          1e-12);
    }
    // The ends keep their directions; inside, the second derivative is continuous.
    const Vec3 before = Evaluate(chains[c], 0.0).d, after = Evaluate(chain, 0.0).d;
    EXPECT_LE(before.normalized().cross(after.normalized()).norm(), 1e-12);
    for (int k = 1; k < chain.spans(); ++k) {
      const auto [left, right] = JetsAtBreak(chain, k);
      EXPECT_LE((left.d - right.d).norm(), 1e-9);
      EXPECT_LE((left.dd - right.dd).norm(), 1e-8);
    }
  }
}

TEST(MeanBreaks, ChainsThatShareTheirBreaksStay) {
  const std::vector<BezierChain> chains = {Through(Arch(0, 8, 0.2, 7)), Through(Arch(5, 8, 0.2, 7))};
  const auto made = WithMeanBreaks(chains);
  ASSERT_TRUE(made.ok());
  for (std::size_t k = 0; k < chains[0].points.size(); ++k)
    EXPECT_LE(((*made)[1].points[k] - chains[1].points[k]).norm(), 1e-12);
}

TEST(MeanBreaks, DifferentNumbersOfSpansAreRefused) {
  EXPECT_FALSE(WithMeanBreaks({Through(Arch(0, 8, 0, 7)), Through(Arch(5, 8, 0, 8))}).ok());
}

}  // namespace
}  // namespace patchmill
