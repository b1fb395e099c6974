#include "core/surface/net_kernel.h"

#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using testing::Random;

double LargestDifference(const Vec4* a, const std::vector<Vec4>& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < b.size(); ++i) worst = std::max(worst, (a[i] - b[i]).norm());
  return worst;
}

class NetKernel : public ::testing::TestWithParam<std::pair<int, int>> {
 protected:
  BernsteinNet Net(bool rational) const {
    const auto [u, v] = GetParam();
    const PatchShape shape = testing::RandomBezier(5, u, v, rational);
    return SplitIntoPieces(PatchId(0), shape).front().net;
  }
};

TEST_P(NetKernel, RestrictingIsTheSubNet) {
  Random random(1);
  for (const bool rational : {false, true}) {
    const BernsteinNet net = Net(rational);
    const NetShape shape{net.degree_u, net.degree_v};
    for (int i = 0; i < 20; ++i) {
      double u0 = random.Unit(), u1 = random.Unit(), v0 = random.Unit(), v1 = random.Unit();
      if (i % 4 == 0) u0 = 0.0;
      if (i % 5 == 0) v1 = 1.0;
      if (u0 > u1) std::swap(u0, u1);
      if (v0 > v1) std::swap(v0, v1);
      std::vector<Vec4> points = net.points;
      RestrictNet(shape, points.data(), {u0, u1, v0, v1});
      EXPECT_LT(LargestDifference(points.data(), SubNet(net, u0, u1, v0, v1).points), 1e-12);
    }
  }
}

TEST_P(NetKernel, HalvesAreTheSubNets) {
  const BernsteinNet net = Net(true);
  const NetShape shape{net.degree_u, net.degree_v};
  std::vector<Vec4> low(net.points.size()), high(net.points.size());
  HalveNet(shape, net.points.data(), true, low.data(), high.data());
  EXPECT_LT(LargestDifference(low.data(), SubNet(net, 0, 0.5, 0, 1).points), 1e-12);
  EXPECT_LT(LargestDifference(high.data(), SubNet(net, 0.5, 1, 0, 1).points), 1e-12);
  HalveNet(shape, net.points.data(), false, low.data(), high.data());
  EXPECT_LT(LargestDifference(low.data(), SubNet(net, 0, 1, 0, 0.5).points), 1e-12);
  EXPECT_LT(LargestDifference(high.data(), SubNet(net, 0, 1, 0.5, 1).points), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Degrees, NetKernel,
                         ::testing::Values(std::pair(1, 1), std::pair(3, 3), std::pair(1, 4), std::pair(7, 2),
                                           std::pair(15, 15)),
                         [](const auto& degrees) {
                           return std::to_string(degrees.param.first) + "x" +
                                  std::to_string(degrees.param.second);
                         });

TEST(MeasureBend, OfAParabolicArchAndAQuarterCircle) {
  // z = 4 h t (1 - t) over a length of 10, straight along v: the arch leaves its chord by h.
  const PatchShape arch =
      BezierPatch{2, 1, {{0, 0, 0}, {0, 3, 0}, {5, 0, 4}, {5, 3, 4}, {10, 0, 0}, {10, 3, 0}}, {}};
  const BernsteinNet net = SplitIntoPieces(PatchId(0), arch).front().net;
  const NetBend bend = MeasureBend({2, 1}, net.points.data(), Vec3::UnitZ(), 0.0);
  EXPECT_NEAR(bend.normal_u, 2.0, 1e-12);
  EXPECT_EQ(bend.normal_v, 0.0);
  EXPECT_NEAR(bend.length_v, 3.0, 1e-12);
  EXPECT_NEAR(bend.curl_u, 1.0 - 10.0 / (2.0 * std::hypot(5.0, 4.0)), 1e-12);
  EXPECT_NEAR(bend.curl_v, 0.0, 1e-12);
}

}  // namespace
}  // namespace patchmill
