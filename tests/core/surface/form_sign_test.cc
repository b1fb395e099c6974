// Balls that touch along lines, against exact circles; random nets against dense points.
#include "core/surface/form_sign.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using testing::Random;

struct Net {
  NetShape shape;
  std::vector<Vec4> points;
};

// A quarter of a circle around the y axis, drawn along y, cut along x at `cut` of its parameter.
Net Trough(double radius, double cut) {
  const double w = std::sqrt(0.5);
  const std::vector<Vec3> rows = {{-radius, 0, 1}, {-w * radius, -w * radius, w}, {0, -radius, 1}};  // x z w
  Net net{{2, 1}, {}};
  for (const Vec3& r : rows) {
    for (const double y : {-4.0, 7.0}) net.points.emplace_back(r.x(), y * r.z(), r.y(), r.z());
  }
  const BernsteinNet whole{2, 1, true, net.points};
  net.points = SubNet(whole, 0.0, cut, 0.0, 1.0).points;
  return net;
}

bool Clears(const Net& net, const Vec3& c, double radius, bool horizontal, int most = 100) {
  std::vector<Vec4> local = net.points;
  for (Vec4& p : local) p.head<3>() -= p.w() * c;
  DistanceForm form;
  MakeDistanceForm(net.shape, local.data(), true, horizontal, radius, form);
  return NowhereNegative(form, most);
}

TEST(NowhereNegative, TouchingAlongALineAndAllOver) {
  constexpr double kOff = 1e-10;
  for (const double cut : {1.0, 0.7, 0.31}) {
    const Net trough = Trough(3.0, cut);
    // A ball in a trough of its own radius touches a quarter of a circle at once.
    EXPECT_TRUE(Clears(trough, {0, 1.3, 0}, 3.0 - kOff, false)) << cut;
    EXPECT_FALSE(Clears(trough, {0, 1.3, 0}, 3.0 + kOff, false)) << cut;
    // A smaller one somewhere touches one place.
    const double angle = Radians(200.0), r = 1.7;
    const Vec3 c((3.0 - r) * std::cos(angle), 2.2, (3.0 - r) * std::sin(angle));
    EXPECT_TRUE(Clears(trough, c, r - kOff, false)) << cut;
    EXPECT_FALSE(Clears(trough, c, r + kOff, false)) << cut;
  }
  // In plan: an upright cylinder touches the trough's end from outside, along a line.
  const Net trough = Trough(3.0, 1.0);
  EXPECT_TRUE(Clears(trough, {-5.0, 1.0, 9.0}, 2.0 - kOff, true));
  EXPECT_FALSE(Clears(trough, {-5.0, 1.0, 9.0}, 2.0 + kOff, true));
  EXPECT_FALSE(Clears(trough, {-2.0, 1.0, 9.0}, 0.5, true));
}

TEST(NowhereNegative, NeverClaimsWhatIsNot) {
  Random random(5);
  int claimed = 0, refused = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const int n = 1 + random.Int(4), m = 1 + random.Int(4);
    const PatchShape shape = testing::RandomBezier(static_cast<std::uint64_t>(trial), n, m, true);
    const BernsteinNet net = SplitIntoPieces(PatchId(0), shape).front().net;
    const Vec3 c(random.Uniform(-5, 15), random.Uniform(-5, 15), random.Uniform(-5, 15));
    double nearest = kInfinity;
    constexpr int kGrid = 40;
    for (int i = 0; i <= kGrid; ++i) {
      for (int j = 0; j <= kGrid; ++j) {
        const double u = static_cast<double>(i) / kGrid, v = static_cast<double>(j) / kGrid;
        const Vec4 p = SubNet(net, u, u, v, v).points.front();
        nearest = std::min(nearest, (p.head<3>() / p.w() - c).norm());
      }
    }
    const Net given{{net.degree_u, net.degree_v}, net.points};
    EXPECT_FALSE(Clears(given, c, 1.0001 * nearest, false, 2000)) << trial;
    for (const double part : {0.999, 0.9}) {
      (Clears(given, c, part * nearest, false, 2000) ? claimed : refused) += part == 0.9;
    }
  }
  // Dense points are nearly as near as any.
  EXPECT_GT(claimed, 9 * refused);
}

}  // namespace
}  // namespace patchmill
