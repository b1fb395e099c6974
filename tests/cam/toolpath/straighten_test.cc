#include "cam/toolpath/straighten.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/clock.h"
#include "tests/support/random.h"
#include "tests/support/sanitized.h"

namespace patchmill {
namespace {

using testing::Random;

Move Cut(const Vec3& to, double feed = 1200.0, int pass = 0) {
  return {.kind = MoveKind::kCut, .to = to, .feed = feed, .pass = pass};
}

double ToChord(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double t = d.squaredNorm() > 0.0 ? std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0) : 0.0;
  return (p - a - t * d).norm();
}

double ToPath(const Vec3& p, const std::vector<Move>& moves) {
  double least = kInfinity;
  for (std::size_t k = 1; k < moves.size(); ++k)
    least = std::min(least, ToChord(p, moves[k - 1].to, moves[k].to));
  return least;
}

Toolpath PathOf(std::vector<Move> moves) {
  moves.insert(moves.begin(), {.kind = MoveKind::kRapid, .to = Vec3::Zero()});
  return {.moves = std::move(moves), .ball_radius = 3.0};
}

TEST(Straighten, JoinsWhatGoesOnStraight) {
  std::vector<Move> moves;
  for (int k = 1; k <= 100; ++k) moves.push_back(Cut({0.3 * k, 0.1 * k, -0.2 * k}));
  for (int k = 1; k <= 100; ++k) moves.push_back(Cut({30.0, 10.0 + k, -20.0}));
  const Toolpath path = Straightened(PathOf(moves));
  ASSERT_EQ(path.moves.size(), 3u);
  EXPECT_EQ(path.moves[1].to, Vec3(30.0, 10.0, -20.0));
  EXPECT_EQ(path.moves[2].to, Vec3(30.0, 110.0, -20.0));
}

// A million moves, straight, bent and nearly straight, in the time of their reading.
TEST(Straighten, TakesLittleTimeForManyMoves) {
  Random random(3);
  for (const double bend : {0.0, 1e-7, 1e-2}) {
    std::vector<Move> moves;
    Vec3 at = Vec3::Zero(), way = Vec3(1, 0, 0);
    for (int k = 0; k < 300'000; ++k) {
      way = (way + bend * random.Point(-1, 1)).normalized();
      at += 0.1 * way;
      moves.push_back(Cut(at));
    }
    const Toolpath path = PathOf(std::move(moves));
    const double start = testing::ClockSeconds(CLOCK_PROCESS_CPUTIME_ID);
    const Toolpath after = Straightened(path);
    EXPECT_LT(testing::ClockSeconds(CLOCK_PROCESS_CPUTIME_ID) - start, testing::kSanitized ? 20.0 : 1.0)
        << bend;
    EXPECT_EQ(after.moves.back().to, path.moves.back().to);
  }
}

TEST(Straighten, KeepsWhatDiffersAndTurnsBack) {
  const Toolpath feeds = Straightened(PathOf({Cut({1, 0, 0}), Cut({2, 0, 0}, 400.0), Cut({3, 0, 0}, 400.0)}));
  EXPECT_EQ(feeds.moves.size(), 3u);
  const Toolpath passes = Straightened(PathOf({Cut({1, 0, 0}), Cut({2, 0, 0}, 1200.0, 1)}));
  EXPECT_EQ(passes.moves.size(), 3u);
  const Toolpath back = Straightened(PathOf({Cut({5, 0, 0}), Cut({2, 0, 0}), Cut({9, 0, 0})}));
  EXPECT_EQ(back.moves.size(), 4u);
  const Toolpath corner = Straightened(PathOf({Cut({5, 0, 0}), Cut({9, 2e-4, 0}), Cut({13, 0, 0})}));
  EXPECT_EQ(corner.moves.size(), 4u);
}

// Random walks, some of them nearly straight: the path changes by less than 2 kStraight, and what stays is
// needed.
TEST(Straighten, ChangesThePathByLessThanItSays) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Random random(seed);
    const double bend = std::pow(10.0, random.Uniform(-7.0, -1.0));
    std::vector<Move> moves;
    Vec3 at = Vec3::Zero(), way = Vec3(1, 0, 0);
    for (int k = 0; k < 200; ++k) {
      way = (way + bend * random.Point(-1, 1)).normalized();
      at += random.Uniform(0.01, 1.0) * way;
      moves.push_back(Cut(at));
    }
    const Toolpath before = PathOf(moves), after = Straightened(before);
    EXPECT_EQ(after.moves.back().to, before.moves.back().to);
    for (const Move& move : before.moves) EXPECT_LT(ToPath(move.to, after.moves), 2.0 * kStraight);
    for (std::size_t k = 1; k < after.moves.size(); ++k) {
      for (const double t : {0.25, 0.5, 0.75}) {
        const Vec3 p = (1.0 - t) * after.moves[k - 1].to + t * after.moves[k].to;
        EXPECT_LT(ToPath(p, before.moves), 2.0 * kStraight);
      }
    }
    int redundant = 0;
    for (std::size_t k = 2; k + 1 < after.moves.size(); ++k)
      redundant += ToChord(after.moves[k].to, after.moves[k - 1].to, after.moves[k + 1].to) < 0.3 * kStraight;
    EXPECT_LE(redundant, 2) << seed;
  }
}

}  // namespace
}  // namespace patchmill
