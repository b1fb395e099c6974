#include "cam/toolpath/corner_feeds.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace patchmill {
namespace {

constexpr double kRadius = 3.0, kFeed = 1200.0;

// A move of pass 0 whose ball touches a wall in the direction `to_wall`.
Move Cut(const Vec3& to, const Vec3& to_wall, double feed = kFeed) {
  Move move{.kind = MoveKind::kCut, .to = to, .feed = feed, .pass = 0};
  move.contact = {to + kRadius * to_wall, PatchId(0)};
  return move;
}

Toolpath PathOf(const Vec3& start, std::vector<Move> moves) {
  moves.insert(moves.begin(), {.kind = MoveKind::kRapid, .to = start});
  return {.moves = std::move(moves), .ball_radius = kRadius};
}

// A circle of centres around the origin, of walls outside (side 1) or inside (side -1).
Toolpath Circle(double radius, double side) {
  std::vector<Move> moves;
  for (int k = 1; k <= 720; ++k) {
    const double angle = 2.0 * kPi * k / 720;
    const Vec3 out(std::cos(angle), std::sin(angle), 0.0);
    moves.push_back(Cut(radius * out, side * out));
  }
  moves.back().to = Vec3(radius, 0, 0);
  return PathOf({radius, 0, 0}, moves);
}

double LengthAt(const Toolpath& path, double feed) {
  double sum = 0.0;
  for (std::size_t i = 1; i < path.moves.size(); ++i)
    if (path.moves[i].feed == feed) sum += (path.moves[i].to - path.moves[i - 1].to).norm();
  return sum;
}

// The ball's centre on a circle of radius r in a bore of radius r + R: the contact runs (r + R) / r as fast.
TEST(CornerFeeds, KeepTheFeedOfTheContactInABore) {
  for (const double r : {2.0, 4.0, 7.0}) {
    const CornerFeedResult slowed = WithCornerFeeds(Circle(r, 1.0), {kFeed, 10.0});
    const double exact = kFeed * r / (r + kRadius);
    for (std::size_t i = 1; i < slowed.toolpath.moves.size(); ++i) {
      // Rounded to tenths of the feed; the window cuts a chord or two of the polygon.
      EXPECT_NEAR(slowed.toolpath.moves[i].feed, exact, 0.055 * kFeed) << r << " " << i;
    }
    EXPECT_NEAR(slowed.slowed_length, 2.0 * kPi * r, 1e-3 * r);
  }
}

TEST(CornerFeeds, LeaveOuterCornersAndWideBoresAlone) {
  for (const Toolpath& path : {Circle(2.0, -1.0), Circle(200.0, 1.0)}) {
    const CornerFeedResult kept = WithCornerFeeds(path, {kFeed, 10.0});
    EXPECT_EQ(kept.slowed_length, 0.0);
    ASSERT_EQ(kept.toolpath.moves.size(), path.moves.size());
    for (std::size_t i = 1; i < path.moves.size(); ++i) {
      EXPECT_EQ(kept.toolpath.moves[i].to, path.moves[i].to);
      EXPECT_EQ(kept.toolpath.moves[i].feed, kFeed);
    }
  }
}

// Along one wall into a corner of 90 degrees, and along the next wall.
Toolpath IntoCorner(double feed) {
  return PathOf({0, 0, 0},
                {Cut({20, 0, 0}, {0, -1, 0}, feed), Cut({50, 0, 0}, Vec3(1, -1, 0).normalized(), feed),
                 Cut({50, 40, 0}, {1, 0, 0}, feed)});
}

// Half a ball radius before the corner and behind it: the turn of 90 degrees over one ball radius.
TEST(CornerFeeds, SlowDownBeforeACornerAndBehindIt) {
  const CornerFeedResult slowed = WithCornerFeeds(IntoCorner(kFeed), {kFeed, 10.0});
  const std::vector<Move>& moves = slowed.toolpath.moves;
  ASSERT_EQ(moves.size(), 6u);
  EXPECT_NEAR((moves[2].to - Vec3(48.5, 0, 0)).norm(), 0.0, 1e-9);
  EXPECT_EQ(moves[3].to, Vec3(50, 0, 0));
  EXPECT_NEAR((moves[4].to - Vec3(50, 1.5, 0)).norm(), 0.0, 1e-9);
  EXPECT_EQ(moves[5].to, Vec3(50, 40, 0));
  for (const std::size_t i : {1, 2, 5}) EXPECT_EQ(moves[i].feed, kFeed);
  const double exact = kFeed / (1.0 + kPi / 2.0);  // 0.389 of the feed
  for (const std::size_t i : {3, 4}) {
    EXPECT_NEAR(moves[i].feed, exact, 0.051 * kFeed);
    EXPECT_EQ(moves[i].pass, 0);
  }
  EXPECT_NEAR(slowed.slowed_length, kRadius, 1e-9);
  EXPECT_FALSE(moves[2].contact.has_value());  // nobody knows it there
  EXPECT_TRUE(moves[3].contact.has_value());
}

TEST(CornerFeeds, GoNoLowerThanTheLeastAndRaiseNothing) {
  const CornerFeedResult slowed = WithCornerFeeds(IntoCorner(kFeed), {kFeed, 900.0});
  EXPECT_NEAR(LengthAt(slowed.toolpath, 900.0), kRadius, 1e-9);
  // Passes at plunge feed keep it.
  const CornerFeedResult plunge = WithCornerFeeds(IntoCorner(300.0), {kFeed, 900.0});
  EXPECT_EQ(plunge.slowed_length, 0.0);
  EXPECT_EQ(plunge.toolpath.moves.size(), 4u);
  const CornerFeedResult same = WithCornerFeeds(IntoCorner(kFeed), {kFeed, kFeed});
  EXPECT_EQ(same.slowed_length, 0.0);
}

// A square pocket that starts in a corner: the seam is a corner like the others.
TEST(CornerFeeds, SeeTheCornerWhereAClosedPassBegins) {
  const std::vector<Vec3> corners = {{20, 0, 0}, {20, 20, 0}, {0, 20, 0}, {0, 0, 0}};
  std::vector<Move> moves;
  for (const Vec3& corner : corners) {
    const Vec3 out = corner - Vec3(10, 10, 0);
    moves.push_back(Cut(corner, out.normalized()));
  }
  const CornerFeedResult slowed = WithCornerFeeds(PathOf({0, 0, 0}, moves), {kFeed, 10.0});
  EXPECT_NEAR(slowed.slowed_length, 4.0 * kRadius, 1e-9);
  EXPECT_LT(slowed.toolpath.moves[1].feed, kFeed);
  EXPECT_LT(slowed.toolpath.moves.back().feed, kFeed);
}

TEST(CornerFeeds, TouchOnlyThePassesThemselves) {
  Toolpath path = IntoCorner(kFeed);
  for (Move& move : path.moves) {
    move.kind = MoveKind::kLink;
    move.pass = -1;
  }
  const CornerFeedResult kept = WithCornerFeeds(path, {kFeed, 10.0});
  EXPECT_EQ(kept.slowed_length, 0.0);
  EXPECT_EQ(kept.toolpath.moves.size(), path.moves.size());
}

// Whatever the pass, its path stays: old ends stay in their order, and new ends lie on the moves.
TEST(CornerFeeds, KeepThePath) {
  std::vector<Move> moves;
  std::vector<Vec3> ends;
  for (int k = 1; k <= 400; ++k) {
    const double t = 0.1 * k;
    ends.emplace_back(3.0 * t, 4.0 * std::sin(2.0 * t), std::cos(3.0 * t));
    moves.push_back(Cut(ends.back(), Vec3(0, std::cos(t), -1).normalized()));
  }
  const Toolpath path = PathOf({0, 0, 1}, moves);
  const CornerFeedResult slowed = WithCornerFeeds(path, {kFeed, 100.0});
  EXPECT_GT(slowed.slowed_length, 0.0);
  std::size_t old = 1;
  double slower = 0.0;
  for (std::size_t i = 1; i < slowed.toolpath.moves.size(); ++i) {
    const Vec3 &from = slowed.toolpath.moves[i - 1].to, &to = slowed.toolpath.moves[i].to;
    const Vec3 a = path.moves[old - 1].to, along = (path.moves[old].to - a).normalized();
    EXPECT_NEAR((to - a).cross(along).norm(), 0.0, 1e-9);
    EXPECT_GT((to - from).dot(along), 0.0);
    if (slowed.toolpath.moves[i].feed < kFeed) slower += (to - from).norm();
    if (to == path.moves[old].to) ++old;
  }
  EXPECT_EQ(old, path.moves.size());
  EXPECT_NEAR(slower, slowed.slowed_length, 1e-9);
}

}  // namespace
}  // namespace patchmill
