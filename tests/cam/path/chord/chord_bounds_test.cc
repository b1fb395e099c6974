#include "cam/path/chord/chord_bounds.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace patchmill {
namespace {

using testing::Random;

// [location T2] on random points: two centres with every point (and everything above the centres, for the
// shank) out of the ball.
TEST(ChordBounds, NoPointIsDeeperThanT2AndTheBoundIsSharp) {
  const double radius = 2.0;
  Random random(1);
  double closest = 0.0;
  for (int trial = 0; trial < 200000; ++trial) {
    const double length = random.Uniform(0.05, 2.0 * radius);
    const Vec3 a(0, 0, 0), b(length, 0, 0);
    const Vec3 p = random.Point(-2.5, 2.5) + Vec3(0.5 * length, 0, 0);
    if (p.norm() < radius || (p - b).norm() < radius) continue;
    const double gouge = radius - SegmentDistance(p, a, b);
    ASSERT_LE(gouge, ChordGouge(radius, length) + 1e-12);
    if (length < radius) closest = std::max(closest, gouge / ChordGouge(radius, length));
  }
  EXPECT_GT(closest, 0.8);
  // Equality for a point that touches both balls.
  const double length = 1.0;
  const Vec3 p(0.5, std::sqrt(radius * radius - 0.25), 0);
  EXPECT_NEAR(radius - SegmentDistance(p, {0, 0, 0}, {length, 0, 0}), ChordGouge(radius, length), 1e-14);
  EXPECT_EQ(ChordGouge(radius, 2 * radius), radius);
}

// The same with free centres between: some on the move, some beside it, above and below.
TEST(ChordBounds, NoPointIsDeeperThanT2AlongFreeCentresSays) {
  const double radius = 2.0;
  Random random(4);
  long tested = 0, bounded = 0;
  double closest = 0.0;
  for (int trial = 0; trial < 20000; ++trial) {
    const double length = random.Uniform(0.1, 4.0), rise = random.Uniform(-1.0, 1.0);
    const Vec3 a(0, 0, 0), b(length, 0, rise * length);
    const double off = std::pow(10.0, random.Uniform(-3.0, -0.5));
    const int inner = random.Int(6);
    std::vector<double> t;
    for (int k = 0; k < inner; ++k) t.push_back(random.Unit());
    std::sort(t.begin(), t.end());
    std::vector<Vec3> free = {a - Vec3(0, 0, trial % 3 == 0 ? 0.1 : 0.0)};
    for (double x : t) free.push_back(x * b + off * random.Point(-1, 1));
    free.push_back(b);
    const double bound = ChordGouge(radius, a, b, free);
    ASSERT_GE(bound, 0.0);
    ASSERT_LE(bound, radius);
    bounded += bound < 0.1 * radius;
    for (int k = 0; k < 60; ++k) {
      // Points near the deepest places: under the move, a little nearer than R.
      const double s = random.Unit();
      Vec3 n = random.Point(-1, 1);
      n.z() = -std::abs(n.z());
      const Vec3 p = s * b + random.Uniform(0.85, 1.0) * radius * n.normalized();
      // The balls reach up for ever: a point is out of one when it is out of its whole upward ray.
      const bool out = std::all_of(free.begin(), free.end(), [&](const Vec3& c) {
        return (Vec3(p.x(), p.y(), std::min(p.z(), c.z())) - c).norm() >= radius;
      });
      if (!out) continue;
      ++tested;
      const double gouge = radius - SegmentDistance(p, a, b);
      ASSERT_LE(gouge, bound + 1e-12) << trial;
      if (bound < 0.1) closest = std::max(closest, gouge / bound);
    }
  }
  EXPECT_GT(tested, 10000);
  EXPECT_GT(bounded, 4000);
  EXPECT_GT(closest, 0.8);
  // Two centres: [location T2] itself. One more on the move between them: T2 of the halves.
  const Vec3 a(0, 0, 0), b(1, 0, 0);
  EXPECT_NEAR(ChordGouge(radius, a, b, std::vector<Vec3>{a, b}), ChordGouge(radius, 1.0), 1e-14);
  EXPECT_NEAR(ChordGouge(radius, a, b, std::vector<Vec3>{a, {0.5, 0, 0}, b}), ChordGouge(radius, 0.5), 1e-14);
  // A centre straight below the move serves as well as one on it, one above it costs its height.
  EXPECT_NEAR(ChordGouge(radius, a, b, std::vector<Vec3>{a, {0.5, 0, -3}, b}), ChordGouge(radius, 0.5),
              1e-14);
  EXPECT_GE(ChordGouge(radius, a, b, std::vector<Vec3>{a, {0.5, 0, 0.03}, b}), 0.03);
}

// [location T3]: no point of a chord is farther from touching one of its two contacts than the bound.
TEST(ChordBounds, NoPointOfTheChordIsFartherThanT3AndTheBoundIsReached) {
  const double radius = 2.0;
  Random random(2);
  for (int trial = 0; trial < 20000; ++trial) {
    const Vec3 a = random.Point(-1, 1), b = random.Point(-1, 1);
    const Vec3 p = a + radius * random.Point(-1, 1).normalized(),
               q = b + radius * random.Point(-1, 1).normalized();
    const bool floor = trial % 5 == 0;
    const double floor_center = std::min(a.z(), b.z()) - random.Uniform(0, 0.5);
    const Support sa{p, floor_center}, sb = floor ? Support{{}, floor_center} : Support{q, floor_center};
    const double bound = ChordExcess(radius, a, b, sa, sb);
    double largest = -kInfinity;
    for (int k = 0; k <= 400; ++k) {
      const Vec3 x = a + (b - a) * (k / 400.0);
      largest = std::max(largest, std::min(sa.Clearance(x, radius), sb.Clearance(x, radius)));
    }
    ASSERT_LE(largest, bound + 1e-12);
    // Two contacts: both clearances meet at the split, so the bound is the largest there is (up to sampling).
    if (!floor) {
      ASSERT_LE(bound, std::max({largest + 0.01, sa.Clearance(a, radius), sb.Clearance(b, radius)}) + 1e-9);
    }
  }
}

}  // namespace
}  // namespace patchmill
