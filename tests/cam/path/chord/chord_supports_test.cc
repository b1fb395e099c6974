#include "cam/path/chord/chord_supports.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/diffgeo/forms.h"
#include "tests/support/joined_surface.h"
#include "tests/support/random.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

constexpr double kR = 3.0;

SurfacePoint At(const Surface& surface, double u, double v) {
  return {PieceId(0), u, v, Position(surface.piece(PieceId(0)), u, v)};
}

// The ball that touches the surface there from above.
Vec3 CenterAt(const Surface& surface, const SurfacePoint& p) {
  Vec3 n = UnitNormal(Evaluate(surface.piece(p.piece), p.u, p.v)).value();
  if (n.z() < 0) n = -n;
  return p.p + kR * n;
}

TEST(SupportParts, CountAThirdOfTheExcessOnAPlane) {
  for (const double length : {0.05, 0.3, 0.7}) {
    for (const double excess : {1e-3, 3e-4, 5e-3}) {
      const int parts = SupportParts(kR, length, excess);
      ASSERT_GE(parts, 2);
      ASSERT_LE(parts, 16);
      const double part = length / parts;
      if (parts < 16) {
        EXPECT_LE(part * part / (8.0 * kR), excess / 3.0 * (1 + 1e-12));
      }
      if (parts > 2) {
        EXPECT_GT(std::pow(length / (parts - 1), 2) / (8.0 * kR), excess / 3.0);
      }
    }
  }
}

TEST(ExcessWithin, AChordOnAPlaneLeavesNothing) {
  const Vec3 a(0, 0, kR), b(0.5, 0, kR);
  const Support left{Vec3(0, 0, 0), -kInfinity}, right{Vec3(0.5, 0, 0), -kInfinity};
  const double limit = 5e-4;
  EXPECT_GT(ChordExcess(kR, a, b, left, right), limit);  // by its ends alone it could
  std::vector<Support> between;
  const int parts = SupportParts(kR, 0.5, limit);
  for (int i = 1; i < parts; ++i) between.push_back({Vec3(0.5 * i / parts, 0, 0), -kInfinity});
  EXPECT_TRUE(ExcessWithin(kR, {a, b, left, right, between}, limit));
  // Raised it leaves what it is raised by.
  const Vec3 up(0, 0, limit);
  EXPECT_FALSE(ExcessWithin(kR, {a + up, b + up, left, right, between}, limit));
}

// Whatever it lets through leaves no more than the limit anywhere, against the distance to dense points; and
// it refuses little that leaves less than half of it.
TEST(ExcessWithin, AgreesWithDenseDistances) {
  Random random(7);
  int yes = 0, no = 0, refused_in_vain = 0;
  for (const bool hollow : {false, true}) {
    const auto height = [&](double x, double y) {
      return (hollow ? 0.04 : -0.04) * (x * x + 0.6 * y * y) + 0.1 * std::sin(0.7 * x + 0.3 * y);
    };
    const Surface surface = JoinedSurface(Single(InterpolatedHeights(height, -4, 4, -4, 4, 3, 3)));
    for (int round = 0; round < 600; ++round) {
      const double u = random.Uniform(0.2, 0.8), v = random.Uniform(0.2, 0.8),
                   way = random.Uniform(0, 2 * kPi), far = std::pow(10.0, random.Uniform(-1.8, -0.7));
      const SurfacePoint p = At(surface, u, v),
                         q = At(surface, u + far * std::cos(way), v + far * std::sin(way));
      const Vec3 a = CenterAt(surface, p), b = CenterAt(surface, q);
      const double limit = std::pow(10.0, random.Uniform(-4, -2.5));
      const std::vector<Support> between =
          SupportsBetween(surface, p, q, SupportParts(kR, (b - a).norm(), limit), -kInfinity);
      const bool within = ExcessWithin(kR, {a, b, {p.p, -kInfinity}, {q.p, -kInfinity}, between}, limit);
      double worst = 0.0;
      for (int i = 0; i <= 40; ++i) {
        const Vec3 x = a + i / 40.0 * (b - a);
        double near = kInfinity;
        for (int k = -10; k <= 50; ++k) {
          for (int side = -6; side <= 6; ++side) {
            const double along = k / 40.0 * far, beside = side / 40.0 * far;
            const SurfacePoint s = At(surface, u + along * std::cos(way) - beside * std::sin(way),
                                      v + along * std::sin(way) + beside * std::cos(way));
            near = std::min(near, (x - s.p).norm());
          }
        }
        worst = std::max(worst, near - kR);
      }
      (within ? yes : no) += 1;
      if (within) {
        EXPECT_LE(worst, limit * (1 + 1e-9) + 1e-12) << round;
      }
      refused_in_vain += !within && worst < 0.5 * limit;
    }
  }
  EXPECT_GT(yes, 300);
  EXPECT_GT(no, 100);
  EXPECT_LT(refused_in_vain, no / 10) << no;
}

}  // namespace
}  // namespace patchmill
