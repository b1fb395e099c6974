// The rules of controls for the ends of arcs, checked on random arcs by plain arithmetic.
#include "cam/post/round_arc.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace patchmill {
namespace {

using testing::Random;

struct Case {
  ExactArc exact;
  double radius = 0.0, begin = 0.0, turn = 0.0;
};

Case RandomCase(Random& random) {
  Case c;
  const auto plane = static_cast<ArcPlane>(random.Int(3));
  c.radius = std::pow(10.0, random.Uniform(-1.3, 3.0));
  c.begin = random.Uniform(-kPi, kPi);
  c.turn = random.Uniform(0.0, 1.0) < 0.2 ? kPi : std::pow(10.0, random.Uniform(-3.0, std::log10(kPi)));
  const bool clockwise = random.Int(2) == 1;
  const Vec2 center(random.Uniform(-90, 90), random.Uniform(-90, 90));
  const auto at = [&](double angle, double z) {
    return FromPlane(plane, Lift(center + c.radius * Vec2(std::cos(angle), std::sin(angle)), z));
  };
  c.exact.arc = {plane, center, clockwise};
  c.exact.ends = {at(c.begin, 2.0), at(c.begin + (clockwise ? -c.turn : c.turn), 2.5)};
  return c;
}

Ticks Rounded(const Vec3& p, double unit) {
  return {std::llround(p.x() / unit), std::llround(p.y() / unit), std::llround(p.z() / unit)};
}

// The strictest rule: 0.005 mm and 0.1 % of the radius, both. And the rounded arc runs beside the exact one.
TEST(RoundedCenter, KeepsTheRuleOfEveryControl) {
  int written = 0;
  for (std::uint64_t seed = 1; seed <= 20'000; ++seed) {
    Random random(seed);
    const Case c = RandomCase(random);
    constexpr double kUnits[] = {1e-3, 1e-4, 25.4e-4, 25.4e-5};  // of programs in mm and in inches
    const double unit = kUnits[random.Int(4)];
    const Ticks from = Rounded(c.exact.ends.from, unit), to = Rounded(c.exact.ends.to, unit);
    const auto center = RoundedCenter(c.exact, from, to, unit);
    if (!center) continue;
    ++written;
    const ArcPlane plane = c.exact.arc.plane;
    const auto place = [&](const Ticks& t) {
      return ToPlane(plane, unit * Vec3(static_cast<double>(t[0]), static_cast<double>(t[1]),
                                        static_cast<double>(t[2])));
    };
    const Vec2 offset = Xy(place(*center)), a = Xy(place(from)), b = Xy(place(to)), middle = a + offset;
    EXPECT_EQ(place(*center).z(), 0.0);
    const double r0 = offset.norm(), r1 = (b - middle).norm();
    ASSERT_LE(std::abs(r0 - r1), 0.005) << seed;
    ASSERT_LE(std::abs(r0 - r1), 0.001 * std::min(r0, r1)) << seed;
    // Ends move by up to 0.71 units, the middle by half a unit more.
    const ArcEnds ends{FromPlane(plane, place(from)), FromPlane(plane, place(to))};
    const Arc rounded{plane, middle, c.exact.arc.clockwise};
    for (const double t : {0.1, 0.3, 0.5, 0.7, 0.9}) {
      const Vec2 p = Xy(ToPlane(plane, PlaceOn(rounded, ends, t)));
      ASSERT_LE(std::abs((p - c.exact.arc.center).norm() - c.radius), 2.0 * unit) << seed << " at " << t;
    }
  }
  EXPECT_GT(written, 10'000);
}

// Full circles have one radius: only the start and the centre are rounded.
TEST(RoundedCenter, TakesFullCircles) {
  const Arc arc{ArcPlane::kZx, Vec2(1.23456, 7.65432), true};
  const Vec3 place = FromPlane(ArcPlane::kZx, Vec3(1.23456 + 5.0, 7.65432, 0.5));
  const Ticks at = Rounded(place, 1e-3);
  const auto center = RoundedCenter({arc, {place, place}}, at, at, 1e-3);
  ASSERT_TRUE(center);
  EXPECT_EQ((*center)[1], 0);
  EXPECT_NEAR(static_cast<double>((*center)[2]), -5000.0, 1.0);
  EXPECT_NEAR(static_cast<double>((*center)[0]), 0.0, 1.0);
}

TEST(RoundedCenter, RefusesWhatRoundingSpoils) {
  // Ends that fall together, or almost.
  const Arc arc{ArcPlane::kXy, Vec2::Zero(), false};
  const auto at = [](double angle) { return Vec3(std::cos(angle), std::sin(angle), 0.0); };
  for (const double turn : {1e-4, 3e-3, 5e-3}) {
    const ArcEnds ends{at(0.0), at(turn)};
    EXPECT_FALSE(RoundedCenter({arc, ends}, Rounded(ends.from, 1e-3), Rounded(ends.to, 1e-3), 1e-3)) << turn;
  }
  const ArcEnds good{at(0.0), at(1.0)};
  EXPECT_TRUE(RoundedCenter({arc, good}, Rounded(good.from, 1e-3), Rounded(good.to, 1e-3), 1e-3));
}

}  // namespace
}  // namespace patchmill
