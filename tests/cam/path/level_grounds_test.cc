// Ground that hangs together has contours of its own, the same that it would have alone.
#include "cam/path/level_grounds.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "cam/path/contour_paths.h"
#include "cam/path/level_heights.h"
#include "tests/support/joined_surface.h"
#include "tests/support/profiles.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

constexpr double kSpacing = 0.5, kFlat = 0.5;
constexpr HeightParams kParams = {.radius = 3.0, .flat = kFlat, .smallest = 0.125};

// A wall from a to b, `height` high; its ball stands off by `off`.
void AddWall(const Vec2& a, const Vec2& b, double height, const Vec2& off, ContourGround& ground) {
  const int along = static_cast<int>(std::ceil((b - a).norm() / kSpacing)),
            up = static_cast<int>(std::ceil(height / kSpacing));
  for (int i = 0; i <= along; ++i) {
    for (int k = 0; k <= up; ++k) {
      const Vec2 q = a + (b - a) * i / along;
      const double half = 0.5 * height / (up + 1);
      ContourSample sample;
      sample.contact = Lift(q, (2 * k + 1) * half);
      sample.center = Lift(Vec2(q + off), sample.contact.z());
      sample.up = sample.down = half;
      sample.step = kFlat;
      sample.width = kSpacing;
      ground.samples.push_back(sample);
    }
  }
  ground.spacing = kSpacing;
}

LevelGrounds GroundsOf(const ContourGround& ground) {
  auto grounds = LevelGrounds::Make(ground, kParams, nullptr, RunContext(1));
  EXPECT_TRUE(grounds.ok());
  return *std::move(grounds);
}

CutterPath PathOf(const std::vector<Vec3>& centers) {
  CutterPath path;
  for (const Vec3& center : centers) path.points.push_back({center, std::nullopt, std::nullopt});
  return path;
}

TEST(LevelGrounds, WallsAroundACornerAreOne) {
  ContourGround outer, inner;
  // Around an outer corner the contacts meet, though the balls stand apart.
  AddWall({0, 0}, {20, 0}, 10, {0, -3}, outer);
  AddWall({20, 0}, {20, 20}, 10, {3, 0}, outer);
  EXPECT_EQ(GroundsOf(outer).size(), 1u);
  // In a slot hardly wider than the ball the balls meet, though the walls do not.
  AddWall({0, 0}, {20, 0}, 10, {0, 3}, inner);
  AddWall({0, 6.5}, {20, 6.5}, 10, {0, -3}, inner);
  EXPECT_EQ(GroundsOf(inner).size(), 1u);
}

TEST(LevelGrounds, WallsApartAreTwo) {
  ContourGround ground;
  AddWall({0, 0}, {20, 0}, 10, {0, 3}, ground);
  AddWall({0, 12}, {40, 12}, 7, {0, -3}, ground);
  ground.lower_ends.push_back({Vec3(5, 3, 0), 1.0});
  ground.lower_ends.push_back({Vec3(9, 9, 0), 1.0});
  ground.lower_ends.push_back({Vec3(30, 9, 0), 1.0});
  const LevelGrounds grounds = GroundsOf(ground);
  ASSERT_EQ(grounds.size(), 2u);
  // The larger one first, 280 and 200 mm2; every sample and every end in one of them.
  EXPECT_EQ(grounds[0].samples.size() + grounds[1].samples.size(), ground.samples.size());
  EXPECT_EQ(grounds[0].lower_ends.size(), 2u);
  EXPECT_EQ(grounds[1].lower_ends.size(), 1u);
  for (const ContourSample& sample : grounds[0].samples) EXPECT_EQ(sample.contact.y(), 12.0);
  for (const ContourSample& sample : grounds[1].samples) EXPECT_EQ(sample.contact.y(), 0.0);
  const CutterPath small = PathOf({Vec3(0, 3, 5), Vec3(20, 3, 5), Vec3(20, 9, 5)});
  EXPECT_EQ(grounds.FamilyUnder(small, std::array<std::size_t, 2>{0, 1}), 1u);
  EXPECT_EQ(grounds.FamilyUnder(small, std::array<std::size_t, 2>{7, 5}), 5u);
}

TEST(LevelGrounds, ScrapsGoWithTheLargest) {
  ContourGround ground;
  AddWall({0, 0}, {20, 0}, 10, {0, 3}, ground);
  AddWall({0, 12}, {40, 12}, 1.9 * kFlat, {0, -3}, ground);
  EXPECT_EQ(GroundsOf(ground).size(), 1u);
  AddWall({0, 30}, {40, 30}, 2.1 * kFlat, {0, -3}, ground);
  EXPECT_EQ(GroundsOf(ground).size(), 2u);
}

// A plate full of dimples: the levels of most are for all of them.
TEST(LevelGrounds, AreNotMoreThanWhatIsWorthIt) {
  ContourGround ground;
  for (int k = 0; k < 300; ++k) {
    const Vec2 from(20.0 * (k % 20), 20.0 * (k / 20.0));
    AddWall(from, from + Vec2(2.0 + 0.01 * k, 0.0), 4, {0, 3}, ground);
  }
  const LevelGrounds grounds = GroundsOf(ground);
  EXPECT_EQ(grounds.size(), 256u);
  std::size_t all = 0;
  for (std::size_t k = 0; k < grounds.size(); ++k) all += grounds[k].samples.size();
  EXPECT_EQ(all, ground.samples.size());
  EXPECT_GT(grounds[0].samples.size(), 44 * grounds[255].samples.size());
}

// A wall from z = 0 to 20, beside it one that needs `step` above z = 10, where the two part.
ContourGround Forked(double step) {
  ContourGround ground, branch;
  AddWall({0, 0}, {40, 0}, 20, {0, -3}, ground);
  AddWall({40, 0}, {80, 0}, 10, {0, -3}, ground);
  AddWall({50, 0}, {80, 0}, 10, {0, -3}, branch);
  for (ContourSample& sample : branch.samples) {
    sample.center.z() += 10.0;
    sample.contact.z() += 10.0;
    sample.step = step;
  }
  ground.samples.insert(ground.samples.end(), branch.samples.begin(), branch.samples.end());
  return ground;
}

// Above `fork` each wall has a contour of its own.
LevelGrounds::ContoursAt ContoursForkedAt(double fork) {
  return [fork](double z) -> std::vector<CutterPath> {
    if (z <= fork) return {PathOf({Vec3(0, -3, z), Vec3(20, -3, z), Vec3(60, -3, z), Vec3(80, -3, z)})};
    return {PathOf({Vec3(0, -3, z), Vec3(40, -3, z)}), PathOf({Vec3(50, -3, z), Vec3(80, -3, z)})};
  };
}

TEST(LevelGrounds, ABranchHasLevelsOfItsOwnWhereTheyAreShorter) {
  ContourGround ground = Forked(0.8 * kFlat);
  ground.lower_ends.push_back({Vec3(60, -3, 12), 1.0});
  for (const double fork : {10.0, 13.0}) {  // between them the ground may rise gently, without samples
    const auto grounds = LevelGrounds::Make(ground, kParams, ContoursForkedAt(fork), RunContext(1));
    ASSERT_TRUE(grounds.ok());
    ASSERT_EQ(grounds->size(), 2u);
    EXPECT_FALSE(grounds->foot(0));
    ASSERT_TRUE(grounds->foot(1));
    EXPECT_EQ(grounds->foot(1)->ground, 0u);
    const double foot = grounds->foot(1)->below;
    EXPECT_GE(foot, fork);
    EXPECT_LE(foot, fork + 3.0 * kFlat);
    EXPECT_EQ((*grounds)[0].samples.size() + (*grounds)[1].samples.size(), ground.samples.size());
    EXPECT_EQ((*grounds)[foot < 12.0 ? 1 : 0].lower_ends.size(), 1u);
    for (const ContourSample& sample : (*grounds)[1].samples) {
      EXPECT_GT(sample.center.z(), foot);
      EXPECT_GE(sample.contact.x(), 50.0);
    }
    for (const ContourSample& sample : (*grounds)[0].samples)
      EXPECT_TRUE(sample.contact.x() <= 40.0 || sample.center.z() <= foot);
    const CutterPath high = PathOf({Vec3(50, -3, 18), Vec3(80, -3, 18)});
    EXPECT_EQ(grounds->FamilyUnder(high, std::array<std::size_t, 2>{0, 1}), 1u);

    // Its levels stand on one of the wall's, each no farther from the next than it needs.
    const auto wall = LevelHeights((*grounds)[0], kParams, RunContext(1));
    ASSERT_TRUE(wall.ok());
    HeightParams on_wall = kParams;
    for (const double z : wall->heights) {
      if (z <= foot) on_wall.foot = z;
    }
    ASSERT_TRUE(on_wall.foot);
    EXPECT_GT(*on_wall.foot, foot - 1.1 * kFlat);
    const auto branch = LevelHeights((*grounds)[1], on_wall, RunContext(1));
    ASSERT_TRUE(branch.ok());
    ASSERT_GT(branch->heights.size(), 10u);
    EXPECT_EQ(branch->heights.front(), *on_wall.foot);
    for (std::size_t i = 0; i + 1 < branch->heights.size(); ++i) {
      const double gap = branch->heights[i + 1] - branch->heights[i];
      EXPECT_LE(gap, kWideGap * 0.8 * kFlat);
      EXPECT_GT(gap, 0.7 * 0.8 * kFlat);
    }
  }
}

TEST(LevelGrounds, ABranchStandsOnTheNextLevelThatGroundLeadsTo) {
  const std::vector<double> heights = {1.0, 2.0, 3.0};
  EXPECT_EQ(LevelBelow(heights, 2.5, kFlat), 2.0);
  EXPECT_EQ(LevelBelow(heights, 3.0, kFlat), 3.0);
  EXPECT_EQ(LevelBelow(heights, 0.5, kFlat), std::nullopt);
  EXPECT_EQ(LevelBelow(heights, 4.2, kFlat), std::nullopt);  // nothing is in so wide a gap
}

TEST(LevelGrounds, NothingBranchesOffWithoutNeed) {
  const auto size = [](const ContourGround& ground, const LevelGrounds::ContoursAt& contours) {
    const auto grounds = LevelGrounds::Make(ground, kParams, contours, RunContext(1));
    EXPECT_TRUE(grounds.ok());
    return grounds->size();
  };
  // The same needs on both; contours that run over both, as high as it goes or nearly; no contours at hand.
  EXPECT_EQ(size(Forked(kFlat), ContoursForkedAt(10.0)), 1u);
  EXPECT_EQ(size(Forked(0.8 * kFlat), ContoursForkedAt(20.0)), 1u);
  EXPECT_EQ(size(Forked(0.8 * kFlat), ContoursForkedAt(18.0)), 1u);
  EXPECT_EQ(size(Forked(0.8 * kFlat), nullptr), 1u);
}

TEST(LevelGrounds, OfNoGround) { EXPECT_EQ(GroundsOf({}).size(), 0u); }

PatchModel Quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  BezierPatch patch;
  patch.degree_u = patch.degree_v = 1;
  patch.points = {a, d, b, c};
  return Single(std::move(patch));
}

ContourParams SteepParams(double scallop = 0.01) {
  ContourParams params;
  params.scallop = scallop;
  params.window.min = Radians(45.0);
  params.floor_z = 0.0;
  return params;
}

std::vector<CutterPath> ContoursOf(const PatchModel& model) {
  const Surface surface = JoinedSurface(model);
  auto result = ContourPaths(Locator(surface, 3.0), SteepParams(), RunContext(2));
  EXPECT_TRUE(result.ok()) << result.status();
  return result.ok() ? std::move(result->paths) : std::vector<CutterPath>();
}

// Samples of a patch much longer than the ball lie farther apart than elsewhere.
TEST(LevelGrounds, ALongPatchIsOne) {
  const double radius = 0.5;
  const Surface surface = JoinedSurface(Quad({0, 0, 0}, {200, 0, 0}, {200, 0.7, 14}, {0, 0.5, 10}));
  const Locator locator(surface, radius);
  const RunContext run(1);
  const auto ground = SampleGround(LevelContext(locator, run), SteepParams(), run);
  ASSERT_TRUE(ground.ok());
  const auto grounds =
      LevelGrounds::Make(*ground, {.radius = radius, .flat = 0.2, .smallest = 0.05}, nullptr, run);
  ASSERT_TRUE(grounds.ok());
  EXPECT_EQ(grounds->size(), 1u);
}

// An upright sheet has contours on both sides, whichever is called the upper one, and whatever stands beside.
TEST(LevelGrounds, BothSidesOfASheet) {
  for (const bool turned : {false, true}) {
    const PatchModel sheet = turned ? Quad({0, 0, 12}, {60, 0, 12}, {60, 0, 0}, {0, 0, 0})
                                    : Quad({0, 0, 0}, {60, 0, 0}, {60, 0, 12}, {0, 0, 12});
    for (const double beside : {9.0, -9.0}) {
      double length[2] = {0.0, 0.0};
      for (const CutterPath& path : ContoursOf(
               Join({sheet, Quad({0, beside, 0}, {60, beside, 0}, {60, beside, 5}, {0, beside, 5}),
                     Quad({0, beside, 5}, {60, beside, 5}, {60, 3 * beside, 5}, {0, 3 * beside, 5})}))) {
        for (std::size_t i = 0; i + 1 < path.points.size(); ++i) {
          const Vec3 &a = path.points[i].center, &b = path.points[i + 1].center;
          if (std::abs(std::abs(a.y()) - 3.0) > 1e-6 || std::abs(b.y() - a.y()) > 1e-6) continue;
          length[a.y() > 0.0] += (b - a).norm();
        }
      }
      EXPECT_GT(length[0], 18 * 55.0);
      EXPECT_NEAR(length[1], length[0], 1e-3 * length[0]) << turned << " " << beside;
    }
  }
}

// Walls that would take more levels than are allowed, each its own, share them as far as that is enough.
TEST(LevelGrounds, ShareLevelsWhereTheyAreTooMany) {
  PatchModel walls;
  constexpr int kWalls = 70;
  double height = 0.0;
  for (int k = 0; k < kWalls; ++k) {
    height = 90.0 + 0.13 * k;
    const double y = 10.0 * k;
    walls = Join({walls, Quad({0, y, 0}, {1, y, 0}, {1, y + 1, height}, {0, y + 1, height})});
  }
  const double radius = 1.0, scallop = 0.001;
  EXPECT_GT(kWalls * 90.0 / CenterStep(radius, scallop, 0.0), static_cast<double>(kMostLevels));
  const Surface surface = JoinedSurface(walls);
  const Locator locator(surface, radius);
  RunContext run(2);
  // They are planned; cutting all of them would take long.
  run.set_progress([&](std::string_view stage, double) {
    if (stage == "contours") run.Cancel();
  });
  const auto result = ContourPaths(locator, SteepParams(scallop), run);
  EXPECT_EQ(result.status().code(), absl::StatusCode::kCancelled) << result.status();
}

// Heights and length of what runs over one part of a surface.
struct Runs {
  std::vector<double> heights;
  double length = 0.0;
};

Runs RunsOver(const PatchModel& model, double from_x, double to_x) {
  Runs runs;
  for (const CutterPath& path : ContoursOf(model)) {
    const Vec3& at = path.points.front().center;
    if (at.x() < from_x || at.x() > to_x) continue;
    runs.heights.push_back(at.z());
    runs.length += Length(path);
  }
  std::sort(runs.heights.begin(), runs.heights.end());
  return runs;
}

// Three bosses whose walls want different steps and whose tops and feet lie at different heights: each is cut
// as if it stood alone.
TEST(LevelGrounds, BossesAreCutAsIfTheyStoodAlone) {
  const auto boss = [](double x, double foot, double height, double draft) {
    const double top = 4.0, bottom = top + height * std::tan(draft);
    return Transformed(Turned({Line({0, foot + height}, {top, foot + height}),
                               Line({top, foot + height}, {bottom, foot}), Line({bottom, foot}, {12, foot})}),
                       Eigen::Affine3d(Eigen::Translation3d(x, 0, 0)));
  };
  const std::vector<PatchModel> bosses = {boss(0.0, 0.0, 9.3, Radians(3.0)),
                                          boss(40.0, 1.37, 12.1, Radians(35.0)),
                                          boss(80.0, 0.71, 6.4, Radians(20.0))};
  const PatchModel all = Join({bosses[0], bosses[1], bosses[2]});
  for (std::size_t k = 0; k < bosses.size(); ++k) {
    const double x = 40.0 * static_cast<double>(k);
    const Runs alone = RunsOver(bosses[k], x - 20.0, x + 20.0), together = RunsOver(all, x - 20.0, x + 20.0);
    ASSERT_GT(alone.heights.size(), 10u);
    ASSERT_EQ(together.heights.size(), alone.heights.size()) << k;
    for (std::size_t i = 0; i < alone.heights.size(); ++i)
      EXPECT_NEAR(together.heights[i], alone.heights[i], 1e-9) << k;
    EXPECT_NEAR(together.length, alone.length, 1e-3 * alone.length) << k;
  }
}

}  // namespace
}  // namespace patchmill
