#include "cam/toolpath/arc.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/enum_array.h"
#include "tests/support/eigen_matchers.h"
#include "tests/support/random.h"

namespace patchmill {
namespace {

using testing::IsNear;
using testing::Random;

// Quarter circles from the first axis of each plane to the second are counter-clockwise (G3). In G18 that is
// from Z to X, as controls have it.
TEST(Arc, TurnsFromTheFirstAxisToTheSecond) {
  const Vec3 x(2, 0, 0), y(0, 2, 0), z(0, 0, 2);
  const double quarter = 0.5 * kPi;
  EXPECT_NEAR(Sweep({ArcPlane::kXy, Vec2::Zero(), false}, {x, y}), quarter, 1e-12);
  EXPECT_NEAR(Sweep({ArcPlane::kZx, Vec2::Zero(), false}, {z, x}), quarter, 1e-12);
  EXPECT_NEAR(Sweep({ArcPlane::kYz, Vec2::Zero(), false}, {y, z}), quarter, 1e-12);
  EXPECT_NEAR(Sweep({ArcPlane::kZx, Vec2::Zero(), true}, {z, x}), 3.0 * quarter, 1e-12);
  EXPECT_NEAR(Sweep({ArcPlane::kXy, Vec2::Zero(), true}, {x, x + 5.0 * z}), 2.0 * kPi, 1e-12);
  const double half = std::sqrt(2.0);
  EXPECT_THAT(PlaceOn({ArcPlane::kZx, Vec2::Zero(), false}, {z, x}, 0.5), IsNear(Vec3(half, 0, half), 1e-12));
}

TEST(Arc, PlanesAndBack) {
  for (const ArcPlane plane : Enumerators<ArcPlane>()) {
    const Vec3 p(1, 2, 3);
    EXPECT_EQ(FromPlane(plane, ToPlane(plane, p)), p);
  }
  EXPECT_EQ(ToPlane(ArcPlane::kZx, Vec3(1, 2, 3)), Vec3(3, 1, 2));
  EXPECT_EQ(ToPlane(ArcPlane::kYz, Vec3(1, 2, 3)), Vec3(2, 3, 1));
}

// Random helices: all places lie on the cylinder, and chords keep their distance.
TEST(Arc, ChordsKeepToTheSagitta) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Random random(seed);
    const auto plane = static_cast<ArcPlane>(random.Int(3));
    const double radius = std::pow(10.0, random.Uniform(-1, 2)), begin = random.Uniform(-kPi, kPi),
                 turn = random.Uniform(0.01, 6.2), sagitta = std::pow(10.0, random.Uniform(-5, -2));
    const bool clockwise = random.Int(2) == 1;
    const Vec2 center(random.Uniform(-50, 50), random.Uniform(-50, 50));
    const auto at = [&](double angle, double z) {
      return FromPlane(plane, Lift(center + radius * Vec2(std::cos(angle), std::sin(angle)), z));
    };
    const Arc arc{plane, center, clockwise};
    const ArcEnds ends{at(begin, 1.0), at(begin + (clockwise ? -turn : turn), 4.0)};
    EXPECT_NEAR(Sweep(arc, ends), turn, 1e-9);
    std::vector<Vec3> places = ChordEnds(arc, ends, sagitta);
    EXPECT_EQ(places.back(), ends.to);
    places.insert(places.begin(), ends.from);
    for (std::size_t k = 1; k < places.size(); ++k) {
      const Vec3 middle = ToPlane(plane, 0.5 * (places[k - 1] + places[k]));
      const double lower = radius - (Xy(middle) - center).norm();
      EXPECT_LE(lower, sagitta * (1.0 + 1e-6) + 1e-12);
      EXPECT_GE(lower, -1e-9);
      EXPECT_NEAR((Xy(ToPlane(plane, places[k])) - center).norm(), radius, 1e-9);
    }
  }
}

TEST(Arc, TurningPlacesAreTheBoxOfTheArc) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Random random(seed);
    const auto plane = static_cast<ArcPlane>(random.Int(3));
    const double begin = random.Uniform(-kPi, kPi), turn = random.Uniform(0.01, 6.2);
    const bool clockwise = random.Int(2) == 1;
    const Vec2 center(3, -4);
    const auto at = [&](double angle) {
      return FromPlane(plane, Lift(center + 7.0 * Vec2(std::cos(angle), std::sin(angle)), 2.0));
    };
    const Arc arc{plane, center, clockwise};
    const ArcEnds ends{at(begin), at(begin + (clockwise ? -turn : turn))};
    Box3 box, sampled;
    box.Add(ends.from);
    box.Add(ends.to);
    for (const Vec3& p : TurningPlaces(arc, ends)) box.Add(p);
    for (int k = 0; k <= 20000; ++k) sampled.Add(PlaceOn(arc, ends, k / 20000.0));
    EXPECT_THAT(box.min, IsNear(sampled.min, 1e-5)) << seed;
    EXPECT_THAT(box.max, IsNear(sampled.max, 1e-5)) << seed;
  }
}

}  // namespace
}  // namespace patchmill
