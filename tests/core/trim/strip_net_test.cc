// The composed patch against its definition: S(u, v(s, t)) at many places.
#include "core/trim/strip_net.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace patchmill {
namespace {

BernsteinNet RandomNet(int p, int q, bool rational, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  BernsteinNet net{p, q, rational, {}};
  for (int k = 0; k < (p + 1) * (q + 1); ++k) {
    const double w = rational ? 0.5 + unit(random) : 1.0;
    net.points.push_back({w * unit(random), w * unit(random), w * unit(random), w});
  }
  return net;
}

Vec3 At(const BernsteinNet& net, double u, double v) {
  Piece piece;
  piece.net = net;
  return Position(piece, u, v);
}

TEST(StripNet, LiesOnTheCarrierAndRunsAsTheStrip) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  struct Case {
    int p, q, degree;
  };
  for (const Case c :
       {Case{3, 3, 1}, {3, 3, 2}, {3, 3, 3}, {2, 1, 3}, {2, 2, 3}, {5, 5, 2}, {1, 1, 3}, {15, 14, 0}}) {
    for (const bool along_u : {true, false}) {
      for (const bool rational : {false, true}) {
        const BernsteinNet net =
            along_u ? RandomNet(c.p, c.q, rational, random) : RandomNet(c.q, c.p, rational, random);
        Strip strip;
        strip.low.along_u = strip.high.along_u = along_u;
        strip.low.from = strip.high.from = 0.2;
        strip.low.to = strip.high.to = 0.9;
        for (int k = 0; k <= c.degree; ++k) {
          const double low = 0.5 * unit(random);
          strip.low.c.push_back(low);
          strip.high.c.push_back(low + (1.0 - low) * unit(random));
        }
        const BernsteinNet patch = StripNet(net, strip);
        EXPECT_EQ(along_u ? patch.degree_u : patch.degree_v, c.p + c.q * c.degree);
        EXPECT_EQ(along_u ? patch.degree_v : patch.degree_u, c.q);
        for (int k = 0; k < 200; ++k) {
          const double s = unit(random), t = unit(random);
          const double x = 0.2 + 0.7 * s, y = (1 - t) * ValueAt(strip.low, x) + t * ValueAt(strip.high, x);
          const Vec3 expected = along_u ? At(net, x, y) : At(net, y, x);
          const Vec3 found = along_u ? At(patch, s, t) : At(patch, t, s);
          ASSERT_LT((found - expected).norm(), 5e-15) << c.p << c.q << c.degree << along_u << rational;
        }
        for (const Vec4& h : patch.points) EXPECT_GT(h.w(), 0.0);
      }
    }
  }
}

TEST(StripNet, DegreesThatFit) {
  const auto largest = [](int p, int q, bool along_u) {
    return LargestStripDegree({p, q, false, {}}, along_u);
  };
  EXPECT_EQ(largest(3, 3, true), 3);
  EXPECT_EQ(largest(2, 1, true), 3);
  EXPECT_EQ(largest(5, 5, true), 2);
  EXPECT_EQ(largest(7, 7, true), 1);
  EXPECT_EQ(largest(8, 8, true), 0);
  EXPECT_EQ(largest(9, 1, false), 1);
}

}  // namespace
}  // namespace patchmill
