#include "cam/verify/motion_at.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace patchmill {
namespace {

constexpr double kR = 3.0;

ProgramMove Straight(ProgramMove::Kind kind, const Vec3& from, const Vec3& to) {
  ProgramMove move;
  move.kind = kind;
  move.from = from;
  move.to = to;
  move.feed = 1000.0;
  return move;
}

MotionAtPoints Measure(const std::vector<Vec3>& points, const ProgramMotion& motion, const Vec3& zero,
                       double leave) {
  auto at = MeasureAt(points, {&motion, zero, kR, leave}, RunContext(2));
  EXPECT_TRUE(at.ok()) << at.status();
  return *std::move(at);
}

// A pass along x with its tip on the plane z = 0: at a distance d beside it sqrt(d^2 + R^2) - R stays.
TEST(MotionAt, OnePassOverAPlaneLeavesTheCircle) {
  const Vec3 zero(10.0, -4.0, 2.0);
  ProgramMotion motion;
  motion.moves = {Straight(ProgramMove::Kind::kFeed, {-50, 0, 0}, {50, 0, 0})};
  std::vector<Vec3> points;
  for (double d = -6.0; d <= 6.0; d += 0.25) points.push_back(zero + Vec3(3.0 * d, d, 0.0));
  for (const double leave : {0.0, 0.2}) {
    // With stock to leave, the tip of a good pass is that much higher.
    for (ProgramMove& move : motion.moves) move.from.z() = move.to.z() = leave;
    const MotionAtPoints at = Measure(points, motion, zero, leave);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double d = points[i].y() - zero.y();
      EXPECT_NEAR(at.leftover[i], std::hypot(d, kR + leave) - kR - leave, 1e-12) << d;
      EXPECT_NEAR(at.gouge[i], 0.0, 1e-12);
    }
  }
}

// Rapids remove nothing, but they gouge; the shank above the ball does, too.
TEST(MotionAt, RapidsGougeAndLeaveEverything) {
  ProgramMotion motion;
  motion.moves = {Straight(ProgramMove::Kind::kRapid, {-50, 0, -1}, {50, 0, -1})};
  const std::vector<Vec3> points = {{0, 0, 0}, {0, 1, 0}, {0, 2.5, 40.0}, {0, 3.5, 0}};
  const MotionAtPoints at = Measure(points, motion, Vec3::Zero(), 0.0);
  EXPECT_NEAR(at.gouge[0], 1.0, 1e-12);
  EXPECT_NEAR(at.gouge[1], kR - std::hypot(1.0, 2.0), 1e-12);
  EXPECT_NEAR(at.gouge[2], 0.5, 1e-12);  // beside the shank's axis by 2.5
  EXPECT_EQ(at.gouge[3], 0.0);
  for (const double left : at.leftover) EXPECT_GT(left, 40.0);
}

// Against plain distances to every move.
TEST(MotionAt, EqualsPlainDistances) {
  testing::Random random(7);
  const auto place = [&] {
    return Vec3(random.Uniform(-20, 20), random.Uniform(-20, 20), random.Uniform(-2, 4));
  };
  ProgramMotion motion;
  Vec3 last = place();
  for (int k = 0; k < 60; ++k) {
    const Vec3 next = place();
    motion.moves.push_back(
        Straight(k % 5 == 0 ? ProgramMove::Kind::kRapid : ProgramMove::Kind::kFeed, last, next));
    last = next;
  }
  std::vector<Vec3> points;
  for (int k = 0; k < 300; ++k) points.push_back(place());
  const MotionAtPoints at = Measure(points, motion, Vec3::Zero(), 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    double nearest = kInfinity, swept = kInfinity;
    for (const ProgramMove& move : motion.moves) {
      const Vec3 up(0, 0, kR), a = move.from + up, d = move.to - move.from;
      const Vec3 r = points[i] - a;
      if (move.kind == ProgramMove::Kind::kFeed) {
        const double t = std::clamp(r.dot(d) / d.squaredNorm(), 0.0, 1.0);
        nearest = std::min(nearest, (r - t * d).norm());
      }
      // The sweep upward: the distance to the nearest of many places, each with a ray up.
      for (int n = 0; n <= 2000; ++n) {
        const Vec3 w = r - n / 2000.0 * d;
        swept = std::min(swept, w.z() > 0.0 ? Xy(w).norm() : w.norm());
      }
    }
    EXPECT_NEAR(at.leftover[i], nearest - kR, 1e-9);
    // No place of the samples is nearer than the nearest of all, nor farther by half the distance of two.
    EXPECT_GE(at.gouge[i], std::max(0.0, kR - swept) - 1e-9);
    EXPECT_LE(at.gouge[i], std::max(0.0, kR - swept) + 0.02);
  }
}

}  // namespace
}  // namespace patchmill
