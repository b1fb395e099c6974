// Bicubic sums: on every instruction set the bits of the generic inner loop.
#include "core/patch/bicubic_sums.h"

#include <array>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "core/patch/tensor_kernel.h"
#include "tests/support/instruction_sets.h"
#include "tests/support/random.h"

namespace patchmill {
namespace {

using Points = std::array<double, 64>;
using Sums = std::array<double, 24>;

// Numbers of very different size, weights among them: sums that round in nearly every step.
Points RandomPoints(testing::Random& random, double digits) {
  Points points;
  for (double& x : points) x = random.Uniform(-1.0, 1.0) * std::pow(10.0, random.Uniform(-digits, digits));
  return points;
}

Sums Generic(const Points& points, const BasisJet& bu, const BasisJet& bv) {
  const internal::HomogeneousJet jet = internal::TensorJet(3, 3, bu, bv, [&](int i, int j) {
    return Vec4(Eigen::Map<const Vec4>(&points[static_cast<std::size_t>(16 * i + 4 * j)]));
  });
  Sums sums;
  Eigen::Map<Eigen::Matrix<double, 4, 6>>(sums.data()) << jet.p, jet.du, jet.dv, jet.duu, jet.duv, jet.dvv;
  return sums;
}

TEST(BicubicSums, AreTheGenericOnesToTheBitOnEveryInstructionSet) {
  for (const InstructionSet set : InstructionSets()) {
    SCOPED_TRACE(Name(set));
    const testing::OnInstructionSet on(set);
    testing::Random random(3);
    for (int k = 0; k < 20'000; ++k) {
      const Points points = RandomPoints(random, k % 4 == 0 ? 100.0 : 2.0);  // tiny products among them
      const double u = k % 7 == 0 ? random.Int(2) : random.Unit(), v = random.Unit();
      BasisJet bu, bv;
      AllBernsteinJet(3, u, bu);
      AllBernsteinJet(3, v, bv);
      Sums sums;
      internal::SumBicubic(points.data(), bu, bv, sums.data());
      const Sums generic = Generic(points, bu, bv);
      ASSERT_EQ(std::memcmp(sums.data(), generic.data(), sizeof sums), 0) << "u " << u << " v " << v;
      BasisJet su, sv;
      AllBernsteinSlopes(3, u, su);
      AllBernsteinSlopes(3, v, sv);
      std::array<double, 12> slopes;
      internal::SumBicubicSlopes(points.data(), su, sv, slopes.data());
      ASSERT_EQ(std::memcmp(slopes.data(), generic.data(), sizeof slopes), 0) << "u " << u << " v " << v;
    }
  }
}

}  // namespace
}  // namespace patchmill
