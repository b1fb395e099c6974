// Distances are measured between dense samples of both paths, with nothing of the fit itself.
#include "cam/toolpath/fit_arcs.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/clock.h"
#include "tests/support/eigen_matchers.h"
#include "tests/support/random.h"
#include "tests/support/sanitized.h"

namespace patchmill {
namespace {

using testing::IsNear;
using testing::Random;

constexpr double kBudget = 0.002;  // mm

Move Cut(const Vec3& to, double feed = 1200.0, int pass = 0) {
  return {.kind = MoveKind::kCut, .to = to, .feed = feed, .pass = pass};
}

// A rapid to the first place and cuts through the others.
Toolpath Through(const std::vector<Vec3>& places) {
  Toolpath path;
  path.moves.push_back({.kind = MoveKind::kRapid, .to = places.front()});
  for (std::size_t k = 1; k < places.size(); ++k) path.moves.push_back(Cut(places[k]));
  path.ball_radius = 3.0;
  return path;
}

Toolpath Along(const std::function<Vec3(double)>& curve, int chords) {
  std::vector<Vec3> places;
  for (int k = 0; k <= chords; ++k) places.push_back(curve(static_cast<double>(k) / chords));
  return Through(places);
}

ArcFit Everything() {
  ArcFit fit;
  fit.budget = kBudget;
  fit.into_surface = kBudget;
  fit.planes = {{true, true, true}};
  fit.plunge_feed = 400.0;
  return fit;
}

// The path as a polyline, its arcs with a sagitta of 1e-5 mm.
std::vector<Vec3> Dense(const Toolpath& path) {
  std::vector<Vec3> places = {path.moves.front().to};
  for (std::size_t k = 1; k < path.moves.size(); ++k) {
    const Move& move = path.moves[k];
    if (!move.arc) {
      places.push_back(move.to);
      continue;
    }
    for (const Vec3& p : ChordEnds(*move.arc, {path.moves[k - 1].to, move.to}, 1e-5)) places.push_back(p);
  }
  return places;
}

Vec3 NearestOf(const Vec3& p, const std::vector<Vec3>& path) {
  Vec3 nearest = path.front();
  double least = (p - nearest).squaredNorm();
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Vec3 &a = path[i - 1], d = path[i] - a;
    const double t = d.squaredNorm() > 0.0 ? std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0) : 0.0;
    const Vec3 q = a + t * d;
    if ((p - q).squaredNorm() >= least) continue;
    least = (p - q).squaredNorm();
    nearest = q;
  }
  return nearest;
}

// The largest distance of samples of one polyline from the other.
double FarthestFrom(const std::vector<Vec3>& samples, const std::vector<Vec3>& path) {
  double most = 0.0;
  for (std::size_t k = 1; k < samples.size(); ++k) {
    for (const double t : {0.5, 1.0}) {
      const Vec3 p = (1.0 - t) * samples[k - 1] + t * samples[k];
      most = std::max(most, (NearestOf(p, path) - p).norm());
    }
  }
  return most;
}

void ExpectWithinBudget(const Toolpath& before, const Toolpath& after, const ArcFit& fit) {
  const std::vector<Vec3> old_path = Dense(before), new_path = Dense(after);
  EXPECT_LE(FarthestFrom(old_path, new_path), fit.budget + 2e-5);
  EXPECT_LE(FarthestFrom(new_path, old_path), fit.budget + 2e-5);
}

int Arcs(const Toolpath& path) {
  return static_cast<int>(
      std::count_if(path.moves.begin(), path.moves.end(), [](const Move& m) { return m.arc.has_value(); }));
}

TEST(FitArcs, ALevelCircleIsOneArc) {
  for (const int chords : {60, 200, 1000}) {
    const Toolpath path = Along(
        [](double t) {
          const double angle = 2.0 * kPi * (t == 1.0 ? 0.0 : t) + 0.3;
          return Vec3(5.0 + 4.0 * std::cos(angle), -2.0 + 4.0 * std::sin(angle), 7.0);
        },
        chords);
    // The sagitta of 60 chords is above the budget.
    const Toolpath after = FitArcs(path, Everything());
    if (chords == 60) {
      EXPECT_EQ(after.moves.size(), path.moves.size());
      continue;
    }
    ASSERT_EQ(after.moves.size(), 2u);
    ASSERT_TRUE(after.moves[1].arc);
    EXPECT_FALSE(after.moves[1].arc->clockwise);
    EXPECT_EQ(after.moves[1].arc->plane, ArcPlane::kXy);
    EXPECT_THAT(after.moves[1].arc->center, IsNear(Vec2(5, -2), 1e-9));
    EXPECT_EQ(after.moves[1].to, path.moves.back().to);
    ExpectWithinBudget(path, after, Everything());
  }
}

// An arc of each plane, both ways round: one move with this centre.
TEST(FitArcs, FindsTheArcOfEachPlane) {
  for (const ArcPlane plane : Enumerators<ArcPlane>()) {
    for (const double turn : {2.0, -2.0}) {
      const auto curve = [&](double t) {
        const double angle = 0.4 + turn * t;
        return FromPlane(plane, Vec3(3.0 + 10.0 * std::cos(angle), 1.0 + 10.0 * std::sin(angle), -6.0));
      };
      const Toolpath path = Along(curve, 70);
      ArcFit fit = Everything();
      fit.plunge_feed = 1200.0;  // these arcs may go down steeply
      const Toolpath after = FitArcs(path, fit);
      ASSERT_EQ(after.moves.size(), 2u);
      ASSERT_TRUE(after.moves[1].arc);
      EXPECT_EQ(after.moves[1].arc->plane, plane);
      EXPECT_EQ(after.moves[1].arc->clockwise, turn < 0.0);
      EXPECT_THAT(after.moves[1].arc->center, IsNear(Vec2(3, 1), 1e-3));
      EXPECT_GT(FitArcs(path, {.budget = kBudget}).moves.size(), 40u);  // without planes
    }
  }
}

// Two and a half turns of a helix: half a turn each.
TEST(FitArcs, AHelixIsHalfTurns) {
  const Toolpath path = Along(
      [](double t) {
        const double angle = 5.0 * kPi * t;
        return Vec3(6.0 * std::cos(angle), 6.0 * std::sin(angle), -2.0 * t);
      },
      700);
  const Toolpath after = FitArcs(path, Everything());
  EXPECT_EQ(after.moves.size(), 6u);
  EXPECT_EQ(Arcs(after), 5);
  ExpectWithinBudget(path, after, Everything());
  ArcFit level = Everything();
  level.helices = false;
  EXPECT_EQ(Arcs(FitArcs(path, level)), 0);
}

// A circle in a plane of no two axes is an ellipse in each of them.
TEST(FitArcs, AnObliqueCircleStaysWithinTheBudget) {
  const Vec3 u = Vec3(1, 2, 0).normalized(), v = Vec3(-2, 1, 3).normalized();
  const Toolpath path =
      Along([&](double t) { return Vec3(8.0 * std::cos(2.0 * t) * u + 8.0 * std::sin(2.0 * t) * v); }, 120);
  ArcFit fit = Everything();
  fit.plunge_feed = 1200.0;
  const Toolpath after = FitArcs(path, fit);
  EXPECT_LT(after.moves.size(), path.moves.size());
  for (const Move& move : after.moves) {
    if (move.arc) {
      EXPECT_LE(Sweep(*move.arc, {Vec3::Zero(), move.to}), 2.0 * kPi);
    }
  }
  ExpectWithinBudget(path, after, fit);
}

// Random smooth paths, some with corners: within the budget both ways, whatever the planes and the shape.
TEST(FitArcs, RandomPathsStayWithinTheBudget) {
  int arcs = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Random random(seed);
    std::vector<Vec3> places = {Vec3::Zero()};
    Vec3 way = random.Point(-1, 1).normalized(), turn = 0.05 * random.Point(-1, 1);
    if (seed % 2 == 0) way.z() = turn.x() = turn.y() = 0.0;  // level paths have arcs
    for (int k = 0; k < 300; ++k) {
      if (random.Int(40) == 0)
        turn = seed % 2 == 0 ? Vec3(0, 0, random.Uniform(-0.2, 0.2)) : Vec3(0.1 * random.Point(-1, 1));
      if (random.Int(80) == 0)
        way = (way + (seed % 2 == 0 ? Vec3(0.3, 0.2, 0) : random.Point(-1, 1))).normalized();
      way = (way + turn.cross(way)).normalized();
      places.push_back(places.back() + random.Uniform(0.05, 0.3) * way);
    }
    const Toolpath path = Through(places);
    ArcFit fit = Everything();
    fit.budget = fit.into_surface = std::pow(10.0, random.Uniform(-4.0, -1.0));
    const Toolpath after = FitArcs(path, fit);
    EXPECT_EQ(after.moves.front().to, path.moves.front().to);
    EXPECT_EQ(after.moves.back().to, path.moves.back().to);
    EXPECT_LE(after.moves.size(), path.moves.size());
    for (std::size_t k = 1; k < after.moves.size(); ++k) {
      if (!after.moves[k].arc) continue;
      ++arcs;
      EXPECT_LE(Sweep(*after.moves[k].arc, {after.moves[k - 1].to, after.moves[k].to}), kPi + 2e-3);
    }
    ExpectWithinBudget(path, after, fit);
    if (HasFailure()) FAIL() << "seed " << seed;
  }
  EXPECT_GT(arcs, 200);
}

// A ring around a pin or in a hole, a little rough: the arc between its places keeps off the contacts.
TEST(FitArcs, KeepsOffTheSurfaceAtTheContacts) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Random random(seed);
    const bool inside = random.Int(2) == 1;
    Toolpath path = Along(
        [&](double t) {
          const double angle = 3.0 * t, radius = 10.0 + random.Uniform(-0.001, 0.001);
          return Vec3(radius * std::cos(angle), radius * std::sin(angle), 0.0);
        },
        90);
    for (Move& move : path.moves) {
      const Vec3 out = move.to.normalized();
      move.contact = MoveContact{move.to + (inside ? 3.0 : -3.0) * out, PatchId(0)};
    }
    ArcFit fit = Everything();
    fit.into_surface = 0.0003;
    const Toolpath after = FitArcs(path, fit);
    const std::vector<Vec3> dense = Dense(after);
    EXPECT_GT(Arcs(after), 0);
    for (const Move& move : path.moves) {
      const Vec3 normal = (move.to - move.contact->p) / 3.0;
      EXPECT_GE((NearestOf(move.to, dense) - move.to).dot(normal), -fit.into_surface - 2e-5) << seed;
    }
  }
}

TEST(FitArcs, KeepsWhatDiffers) {
  const auto curve = [](double t) { return Vec3(10.0 * std::cos(t), 10.0 * std::sin(t), 0.0); };
  const auto spoil = [&](const std::function<void(Move&)>& change) {
    Toolpath path = Along(curve, 40);
    for (std::size_t k = 20; k < path.moves.size(); ++k) change(path.moves[k]);
    const Toolpath after = FitArcs(path, Everything());
    EXPECT_EQ(after.moves.size(), 3u);
    if (after.moves.size() == 3u) {
      EXPECT_EQ(after.moves[1].to, path.moves[19].to);
    }
  };
  spoil([](Move& m) { m.feed = 600.0; });
  spoil([](Move& m) { m.pass = 1; });
  spoil([](Move& m) { m.region = RegionId(4); });
  Toolpath links = Along(curve, 40);
  for (Move& move : links.moves) move.kind = MoveKind::kLink;
  EXPECT_EQ(FitArcs(links, Everything()).moves.size(), links.moves.size());
}

// At the feed of cutting an arc goes down at 30 degrees at most, also where its chords are less steep.
// Each call fits the moves of one kind.
TEST(FitArcs, OnlyMovesOfItsKindBecomeArcs) {
  Toolpath path = Along([](double t) { return Vec3(5 * std::cos(3 * t), 5 * std::sin(3 * t), 0); }, 60);
  for (std::size_t k = 1; k <= 20; ++k) path.moves[k].kind = MoveKind::kLead;
  ArcFit leads = Everything();
  leads.kind = MoveKind::kLead;
  const Toolpath fitted = FitArcs(path, leads);
  ASSERT_EQ(fitted.moves.size(), 1u + 1u + 40u);
  EXPECT_TRUE(fitted.moves[1].arc.has_value());
  EXPECT_EQ(fitted.moves[1].kind, MoveKind::kLead);
  for (std::size_t k = 2; k < fitted.moves.size(); ++k) EXPECT_FALSE(fitted.moves[k].arc.has_value());
  EXPECT_EQ(FitArcs(fitted, Everything()).moves.size(), 3u);
}

TEST(FitArcs, ArcsAreNoSteeperThanAllowed) {
  int arcs = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Random random(seed);
    const double radius = random.Uniform(0.5, 20.0), begin = random.Uniform(0.0, 0.5), end = 1.2;
    const Toolpath path = Along(
        [&](double t) {
          const double angle = begin + (end - begin) * t;  // 0: on top
          return Vec3(radius * std::sin(angle), 0.1 * t, radius * std::cos(angle));
        },
        2 + random.Int(100));
    const ArcFit fit = Everything();
    const Toolpath after = FitArcs(path, fit);
    for (std::size_t k = 1; k < after.moves.size(); ++k) {
      if (!after.moves[k].arc) continue;
      ++arcs;
      const ArcEnds ends{after.moves[k - 1].to, after.moves[k].to};
      for (int i = 0; i < 1000; ++i) {
        const Vec3 d = PlaceOn(*after.moves[k].arc, ends, (i + 1) / 1000.0) -
                       PlaceOn(*after.moves[k].arc, ends, i / 1000.0);
        EXPECT_LE(std::atan2(-d.z(), Xy(d).norm()), fit.plunge_angle + 1e-6);
      }
    }
  }
  EXPECT_GT(arcs, 20);
}

// A trough whose lowest place lies between two ends: the arc would go below the floor there.
TEST(FitArcs, ArcsDoNotGoBelowTheFloor) {
  const Toolpath path = Along(
      [](double t) {
        const double angle = 0.4 * (t - 0.5);
        return Vec3(20.0 * std::sin(angle), 0.0, -20.0 * std::cos(angle));
      },
      25);
  ArcFit fit = Everything();
  EXPECT_EQ(FitArcs(path, fit).moves.size(), 2u);
  fit.lowest = -20.0;
  const Toolpath after = FitArcs(path, fit);
  EXPECT_GT(after.moves.size(), 2u);
  EXPECT_GT(Arcs(after), 0);
  for (const Vec3& p : Dense(after)) EXPECT_GE(p.z(), -20.0);
}

TEST(FitArcs, TakesLittleTimeForManyMoves) {
  for (const double radius : {10.0, 1e5}) {
    const Toolpath path = Along(
        [&](double t) {
          const double angle = 3e5 * 0.1 / radius * t;
          return Vec3(radius * std::cos(angle), radius * std::sin(angle), 0.0);
        },
        300'000);
    const double start = testing::ClockSeconds(CLOCK_PROCESS_CPUTIME_ID);
    const Toolpath after = FitArcs(path, Everything());
    EXPECT_LT(testing::ClockSeconds(CLOCK_PROCESS_CPUTIME_ID) - start, testing::kSanitized ? 60.0 : 4.0);
    EXPECT_LT(after.moves.size(), path.moves.size() / 50);
  }
}

// Half a circle twice, as two passes.
TEST(FitArcs, LeavesStraightPassesAsTheyAre) {
  const auto half = [](double t) { return Vec3(10.0 * std::cos(kPi * t), 10.0 * std::sin(kPi * t), 0.0); };
  Toolpath path = Along(half, 100);
  for (int k = 99; k >= 0; --k) path.moves.push_back(Cut(half(k / 100.0), 1200.0, 1));
  ArcFit fit = Everything();
  EXPECT_EQ(FitArcs(path, fit).moves.size(), 3u);
  fit.straight_passes = {false, true};
  const Toolpath fitted = FitArcs(path, fit);
  ASSERT_EQ(fitted.moves.size(), 102u);
  EXPECT_TRUE(fitted.moves[1].arc.has_value());
  for (std::size_t k = 2; k < fitted.moves.size(); ++k) {
    EXPECT_FALSE(fitted.moves[k].arc.has_value());
    EXPECT_EQ(fitted.moves[k].to, path.moves[k + 99].to);
  }
}

}  // namespace
}  // namespace patchmill
