// Bounds of bicubic nets against the derivative nets themselves.
#include "cam/location/bicubic_bounds.h"

#include <array>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "core/base/vec.h"
#include "tests/support/instruction_sets.h"
#include "tests/support/random.h"

namespace patchmill {
namespace {

using internal::BicubicBounds;
using internal::BoundBicubic;
using testing::Random;

struct Net {
  std::array<double, 64> numbers{};
  Vec3 At(int i, int j) const {
    return Eigen::Map<const Vec3>(&numbers[static_cast<std::size_t>(16 * i + 4 * j)]);
  }
};

struct Model {
  Vec3 s, a, b, uu, uv, vv;
  internal::ModelVectors View() const {
    return {s.data(), a.data(), b.data(), uu.data(), uv.data(), vv.data()};
  }
};

struct Most {
  double squared = 0.0, a = 0.0, b = 0.0;
  void Add(const Vec3& d, const Model& m) {
    squared = std::max(squared, d.squaredNorm());
    a = std::max(a, std::abs(d.dot(m.a)));
    b = std::max(b, std::abs(d.dot(m.b)));
  }
};

void ExpectBounds(const BicubicBounds& bounds, const Net& net, const Model& m) {
  Most reach, du, dv, uu, uv, vv;
  double along[3] = {}, top = -kInfinity;
  const Vec3 seconds[3] = {m.uu, m.uv, m.vv};
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const Vec3 p = net.At(i, j);
      reach.Add(p - m.s, m);
      for (int k = 0; k < 3; ++k) along[k] = std::max(along[k], std::abs((p - m.s).dot(seconds[k])));
      top = std::max(top, p.z());
      if (i < 3) du.Add(3.0 * (net.At(i + 1, j) - p) - m.a, m);
      if (j < 3) dv.Add(3.0 * (net.At(i, j + 1) - p) - m.b, m);
      if (i < 2) uu.Add(6.0 * (net.At(i + 2, j) - 2.0 * net.At(i + 1, j) + p) - m.uu, m);
      if (j < 2) vv.Add(6.0 * (net.At(i, j + 2) - 2.0 * net.At(i, j + 1) + p) - m.vv, m);
      if (i < 3 && j < 3)
        uv.Add(9.0 * (net.At(i + 1, j + 1) - net.At(i + 1, j) - net.At(i, j + 1) + p) - m.uv, m);
    }
  }
  const auto near = [](double found, double exact) { EXPECT_NEAR(found, exact, 1e-12 * (1.0 + exact)); };
  EXPECT_EQ(bounds.z_max, top);
  near(bounds.reach2, reach.squared);
  near(bounds.reach_a, reach.a);
  near(bounds.reach_b, reach.b);
  near(bounds.reach_uu, along[0]);
  near(bounds.reach_uv, along[1]);
  near(bounds.reach_vv, along[2]);
  near(bounds.du2, du.squared);
  near(bounds.du_a, du.a);
  near(bounds.du_b, du.b);
  near(bounds.dv2, dv.squared);
  near(bounds.dv_a, dv.a);
  near(bounds.dv_b, dv.b);
  near(bounds.uu2, uu.squared);
  near(bounds.uv2, uv.squared);
  near(bounds.vv2, vv.squared);
}

// One point after the other is the one that strays most, so that none can be left out.
TEST(BicubicBounds, AreTheLargestOfTheDerivativeNetsOnEveryInstructionSet) {
  Random random(5);
  for (int round = 0; round < 400; ++round) {
    Net net;
    for (double& x : net.numbers) x = random.Uniform(-1.0, 1.0);
    for (int k = 0; k < 3; ++k)
      net.numbers[static_cast<std::size_t>(4 * (round % 16) + k)] += random.Uniform(-3.0, 3.0);
    const auto vector = [&] { return Vec3(random.Point(-1.0, 1.0)); };
    const Model m{vector(), vector(), vector(), vector(), vector(), vector()};
    const BicubicBounds first = BoundBicubic(net.numbers.data(), m.View());
    ExpectBounds(first, net, m);
    for (const InstructionSet set : InstructionSets()) {
      const testing::OnInstructionSet on(set);
      const BicubicBounds bounds = BoundBicubic(net.numbers.data(), m.View());
      ASSERT_EQ(std::memcmp(&bounds, &first, sizeof bounds), 0) << Name(set);
    }
  }
}

// At the numbers they replace: what is 0 there stays 0.
TEST(BicubicBounds, OfABilinearPatchHaveNoBend) {
  Net net;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j)
      Eigen::Map<Vec3>(&net.numbers[static_cast<std::size_t>(16 * i + 4 * j)]) =
          Vec3(3.0 * i, 2.0 * j, i * j);
  }
  const Model m{Vec3(4.5, 3.0, 2.25), Vec3(9, 0, 4.5), Vec3(0, 6, 4.5),
                Vec3::Zero(),         Vec3(0, 0, 9),   Vec3::Zero()};
  const BicubicBounds bounds = BoundBicubic(net.numbers.data(), m.View());
  EXPECT_EQ(bounds.uu2, 0.0);
  EXPECT_EQ(bounds.uv2, 0.0);
  EXPECT_EQ(bounds.vv2, 0.0);
  EXPECT_DOUBLE_EQ(bounds.du2, 4.5 * 4.5);
  EXPECT_DOUBLE_EQ(bounds.z_max, 9.0);
}

}  // namespace
}  // namespace patchmill
