// Search trees and heights over surfaces whose parametrisation stands still on a line, or whose weights are
// far apart: as many leaves as the point set needs, and exact heights.
#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "cam/location/locator.h"
#include "cam/location/search_tree.h"
#include "tests/support/hard_parts.h"
#include "tests/support/random.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using testing::Random;
using testing::SurfaceOf;

std::size_t LeafCount(const Surface& surface, double radius) {
  return internal::BuildSearchTree(surface, radius, RunContext())->leaves.size();
}

// The cubic x = 30 sign(s) |s|^3, z = z0 - drop s^2 with s = (u - at) / (larger of at, 1 - at).
PatchModel Stationary(double at, double z0, double drop) {
  const double stretch = 1.0 / std::max(at, 1.0 - at);
  // Blossoms: the polar forms of s^3 and s^2 at the knots 0 0 0, 0 0 1, 0 1 1, 1 1 1.
  std::array<Vec2, 4> section;
  for (int k = 0; k <= 3; ++k) {
    const double a = -at * stretch, b = (1.0 - at) * stretch;
    const double s1 = k > 2 ? b : a, s2 = k > 1 ? b : a, s3 = k > 0 ? b : a;
    section[static_cast<std::size_t>(k)] =
        Vec2(30.0 * s1 * s2 * s3, z0 - drop * (s1 * s2 + s2 * s3 + s3 * s1) / 3.0);
  }
  return testing::CubicRuled(section, 60.0);
}

TEST(StationaryLines, ATreeHasAsManyLeavesAsThePointsNeed) {
  for (const double at : {0.0, 0.2, 1.0 / 3.0, 0.37, 0.5, 0.9}) {
    EXPECT_LT(LeafCount(SurfaceOf(Stationary(at, 0.0, 0.0)), 3.0), 6000u) << at;
    EXPECT_LT(LeafCount(SurfaceOf(Stationary(at, 20.0, 20.0)), 3.0), 6000u) << at;
  }
}

TEST(StationaryLines, APlaneInAnyParametersIsAPlane) {
  Random random(5);
  for (const double at : {0.2, 1.0 / 3.0, 0.5}) {
    const Surface surface = SurfaceOf(Stationary(at, 7.0, 0.0));
    const Locator locator(surface, 3.0);
    for (int k = 0; k < 200; ++k) {
      const Vec2 q(random.Uniform(surface.box.min.x(), surface.box.max.x()), random.Uniform(0.0, 60.0));
      const auto h = locator.CertifiedHeight(q, 1e-6);
      ASSERT_TRUE(h);
      EXPECT_NEAR(h->z, 10.0, 1e-9);
      EXPECT_LE(h->gap, 1e-6);
    }
  }
}

// The ridge z = 20 - 20 (|x| / 30)^(2/3), against the highest ball over a fine sample of the section.
TEST(StationaryLines, ABallOnACusp) {
  const Surface surface = SurfaceOf(testing::CuspedRidge());
  const Locator locator(surface, 3.0);
  Random random(6);
  for (int k = 0; k < 100; ++k) {
    const double x = random.Uniform(-6.0, 6.0), y = random.Uniform(5.0, 55.0);
    double highest = -kInfinity;
    constexpr int kSamples = 40000;
    for (int i = -kSamples; i <= kSamples; ++i) {
      const double s = 0.8 * i / kSamples, px = 30.0 * s * s * s;
      const double under = 9.0 - (px - x) * (px - x);
      if (under > 0.0) highest = std::max(highest, 20.0 - 20.0 * s * s + std::sqrt(under));
    }
    const auto h = locator.CertifiedHeight({x, y}, 1e-6);
    ASSERT_TRUE(h);
    EXPECT_LE(h->gap, 1e-6);
    EXPECT_GE(h->z, highest - 1e-9) << x;
    EXPECT_LE(h->z, highest + 1e-5) << x;
  }
}

TEST(UnevenWeights, CostWhatEvenOnesCost) {
  const Surface even = SurfaceOf(testing::WeightedOctant(1.0));
  const Locator plain(even, 3.0);
  Random random(7);
  for (const double ratio : {1e3, 1e6, 1e9}) {
    const Surface surface = SurfaceOf(testing::WeightedOctant(ratio));
    EXPECT_LE(LeafCount(surface, 3.0), 2 * LeafCount(even, 3.0)) << ratio;
    const Locator locator(surface, 3.0);
    for (int k = 0; k < 200; ++k) {
      const Vec2 q(random.Uniform(-2.0, 32.0), random.Uniform(-2.0, 32.0));
      const auto h = locator.Height(q), expected = plain.Height(q);
      ASSERT_EQ(h.has_value(), expected.has_value());
      if (h) {
        EXPECT_NEAR(h->z, expected->z, 1e-9);
      }
    }
  }
}

}  // namespace
}  // namespace patchmill
