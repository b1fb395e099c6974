// Each connected area has its own contours, the same as if it were alone.
#include "cam/path/contour/level_groups.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "cam/path/contour/contour_paths.h"
#include "cam/path/contour/level_heights.h"
#include "tests/support/joined_surface.h"
#include "tests/support/profiles.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

constexpr double kSpacing = 0.5, kFlat = 0.5;
constexpr HeightParams kParams = {.radius = 3.0, .flat = kFlat, .smallest = 0.125};

// A wall from a to b, `height` high; its ball stands off by `off`.
void AddWall(const Vec2& a, const Vec2& b, double height, const Vec2& off, ContourArea& contour_area) {
  const int along = static_cast<int>(std::ceil((b - a).norm() / kSpacing)),
            up = static_cast<int>(std::ceil(height / kSpacing));
  for (int i = 0; i <= along; ++i) {
    for (int k = 0; k <= up; ++k) {
      const Vec2 q = a + (b - a) * i / along;
      const double half = 0.5 * height / (up + 1);
      ContourSample sample;
      sample.contact = Lift(q, (2 * k + 1) * half);
      sample.center = Lift(Vec2(q + off), sample.contact.z());
      sample.above = sample.below = half;
      sample.step = kFlat;
      sample.width = kSpacing;
      contour_area.samples.push_back(sample);
    }
  }
  contour_area.spacing = kSpacing;
}

LevelGroups GroupsOf(const ContourArea& contour_area) {
  auto groups = LevelGroups::Make(contour_area, kParams, nullptr, RunContext(1));
  EXPECT_TRUE(groups.ok());
  return *std::move(groups);
}

CutterPath PathOf(const std::vector<Vec3>& centers) {
  CutterPath path;
  for (const Vec3& center : centers) path.points.push_back({center, std::nullopt, std::nullopt});
  return path;
}

TEST(LevelGroups, WallsAroundACornerAreOne) {
  ContourArea outer, inner;
  // Around an outer corner the contacts meet, though the balls stand apart.
  AddWall({0, 0}, {20, 0}, 10, {0, -3}, outer);
  AddWall({20, 0}, {20, 20}, 10, {3, 0}, outer);
  EXPECT_EQ(GroupsOf(outer).size(), 1u);
  // In a slot hardly wider than the ball the balls meet, though the walls do not.
  AddWall({0, 0}, {20, 0}, 10, {0, 3}, inner);
  AddWall({0, 6.5}, {20, 6.5}, 10, {0, -3}, inner);
  EXPECT_EQ(GroupsOf(inner).size(), 1u);
}

TEST(LevelGroups, WallsApartAreTwo) {
  ContourArea contour_area;
  AddWall({0, 0}, {20, 0}, 10, {0, 3}, contour_area);
  AddWall({0, 12}, {40, 12}, 7, {0, -3}, contour_area);
  contour_area.lower_ends.push_back({Vec3(5, 3, 0), 1.0});
  contour_area.lower_ends.push_back({Vec3(9, 9, 0), 1.0});
  contour_area.lower_ends.push_back({Vec3(30, 9, 0), 1.0});
  const LevelGroups groups = GroupsOf(contour_area);
  ASSERT_EQ(groups.size(), 2u);
  // The larger one first, 280 and 200 mm2; every sample and every end in one of them.
  EXPECT_EQ(groups[LevelGroupId(0)].samples.size() + groups[LevelGroupId(1)].samples.size(),
            contour_area.samples.size());
  EXPECT_EQ(groups[LevelGroupId(0)].lower_ends.size(), 2u);
  EXPECT_EQ(groups[LevelGroupId(1)].lower_ends.size(), 1u);
  for (const ContourSample& sample : groups[LevelGroupId(0)].samples) EXPECT_EQ(sample.contact.y(), 12.0);
  for (const ContourSample& sample : groups[LevelGroupId(1)].samples) EXPECT_EQ(sample.contact.y(), 0.0);
  const CutterPath small = PathOf({Vec3(0, 3, 5), Vec3(20, 3, 5), Vec3(20, 9, 5)});
  EXPECT_EQ(groups.FamilyUnder(small, std::array{LevelFamilyId(0), LevelFamilyId(1)}), LevelFamilyId(1));
  EXPECT_EQ(groups.FamilyUnder(small, std::array{LevelFamilyId(7), LevelFamilyId(5)}), LevelFamilyId(5));
}

TEST(LevelGroups, ScrapsGoWithTheLargest) {
  ContourArea contour_area;
  AddWall({0, 0}, {20, 0}, 10, {0, 3}, contour_area);
  AddWall({0, 12}, {40, 12}, 1.9 * kFlat, {0, -3}, contour_area);
  EXPECT_EQ(GroupsOf(contour_area).size(), 1u);
  AddWall({0, 30}, {40, 30}, 2.1 * kFlat, {0, -3}, contour_area);
  EXPECT_EQ(GroupsOf(contour_area).size(), 2u);
}

// A plate full of dimples: the levels of most are for all of them.
TEST(LevelGroups, AreNotMoreThanWhatIsWorthIt) {
  ContourArea contour_area;
  for (int k = 0; k < 300; ++k) {
    const Vec2 from(20.0 * (k % 20), 20.0 * (k / 20.0));
    AddWall(from, from + Vec2(2.0 + 0.01 * k, 0.0), 4, {0, 3}, contour_area);
  }
  const LevelGroups groups = GroupsOf(contour_area);
  EXPECT_EQ(groups.size(), 256u);
  std::size_t all = 0;
  for (std::size_t k = 0; k < groups.size(); ++k) all += groups[LevelGroupId(k)].samples.size();
  EXPECT_EQ(all, contour_area.samples.size());
  EXPECT_GT(groups[LevelGroupId(0)].samples.size(), 44 * groups[LevelGroupId(255)].samples.size());
}

// A wall from z = 0 to 20, beside it one that needs `step` above z = 10, where the two part.
ContourArea Forked(double step) {
  ContourArea contour_area, branch;
  AddWall({0, 0}, {40, 0}, 20, {0, -3}, contour_area);
  AddWall({40, 0}, {80, 0}, 10, {0, -3}, contour_area);
  AddWall({50, 0}, {80, 0}, 10, {0, -3}, branch);
  for (ContourSample& sample : branch.samples) {
    sample.center.z() += 10.0;
    sample.contact.z() += 10.0;
    sample.step = step;
  }
  contour_area.samples.insert(contour_area.samples.end(), branch.samples.begin(), branch.samples.end());
  return contour_area;
}

// Above `fork` each wall has a contour of its own.
LevelGroups::ContoursAt ContoursForkedAt(double fork) {
  return [fork](double z) -> std::vector<CutterPath> {
    if (z <= fork) return {PathOf({Vec3(0, -3, z), Vec3(20, -3, z), Vec3(60, -3, z), Vec3(80, -3, z)})};
    return {PathOf({Vec3(0, -3, z), Vec3(40, -3, z)}), PathOf({Vec3(50, -3, z), Vec3(80, -3, z)})};
  };
}

TEST(LevelGroups, ABranchHasLevelsOfItsOwnWhereTheyAreShorter) {
  ContourArea contour_area = Forked(0.8 * kFlat);
  contour_area.lower_ends.push_back({Vec3(60, -3, 12), 1.0});
  for (const double fork : {10.0, 13.0}) {  // the surface between may rise gently, without samples
    const auto groups = LevelGroups::Make(contour_area, kParams, ContoursForkedAt(fork), RunContext(1));
    ASSERT_TRUE(groups.ok());
    ASSERT_EQ(groups->size(), 2u);
    EXPECT_FALSE(groups->base_level(LevelGroupId(0)));
    ASSERT_TRUE(groups->base_level(LevelGroupId(1)));
    EXPECT_EQ(groups->base_level(LevelGroupId(1))->group, LevelGroupId(0));
    const double base_level = groups->base_level(LevelGroupId(1))->below;
    EXPECT_GE(base_level, fork);
    EXPECT_LE(base_level, fork + 3.0 * kFlat);
    EXPECT_EQ((*groups)[LevelGroupId(0)].samples.size() + (*groups)[LevelGroupId(1)].samples.size(),
              contour_area.samples.size());
    EXPECT_EQ((*groups)[LevelGroupId(base_level < 12.0 ? 1 : 0)].lower_ends.size(), 1u);
    for (const ContourSample& sample : (*groups)[LevelGroupId(1)].samples) {
      EXPECT_GT(sample.center.z(), base_level);
      EXPECT_GE(sample.contact.x(), 50.0);
    }
    for (const ContourSample& sample : (*groups)[LevelGroupId(0)].samples)
      EXPECT_TRUE(sample.contact.x() <= 40.0 || sample.center.z() <= base_level);
    const CutterPath high = PathOf({Vec3(50, -3, 18), Vec3(80, -3, 18)});
    EXPECT_EQ(groups->FamilyUnder(high, std::array{LevelFamilyId(0), LevelFamilyId(1)}), LevelFamilyId(1));

    // Its levels stand on one of the wall's, each no farther from the next than it needs.
    const auto wall = LevelHeights((*groups)[LevelGroupId(0)], kParams, RunContext(1));
    ASSERT_TRUE(wall.ok());
    HeightParams on_wall = kParams;
    for (const double z : wall->heights) {
      if (z <= base_level) on_wall.base_level = z;
    }
    ASSERT_TRUE(on_wall.base_level);
    EXPECT_GT(*on_wall.base_level, base_level - 1.1 * kFlat);
    const auto branch = LevelHeights((*groups)[LevelGroupId(1)], on_wall, RunContext(1));
    ASSERT_TRUE(branch.ok());
    ASSERT_GT(branch->heights.size(), 10u);
    EXPECT_EQ(branch->heights.front(), *on_wall.base_level);
    for (std::size_t i = 0; i + 1 < branch->heights.size(); ++i) {
      const double gap = branch->heights[i + 1] - branch->heights[i];
      EXPECT_LE(gap, kWideGap * 0.8 * kFlat);
      EXPECT_GT(gap, 0.7 * 0.8 * kFlat);
    }
  }
}

TEST(LevelGroups, ABranchStandsOnTheNextLevelThatSurfaceLeadsTo) {
  const std::vector<double> heights = {1.0, 2.0, 3.0};
  EXPECT_EQ(LevelBelow(heights, 2.5, kFlat), 2.0);
  EXPECT_EQ(LevelBelow(heights, 3.0, kFlat), 3.0);
  EXPECT_EQ(LevelBelow(heights, 0.5, kFlat), std::nullopt);
  EXPECT_EQ(LevelBelow(heights, 4.2, kFlat), std::nullopt);  // nothing is in so wide a gap
}

TEST(LevelGroups, NothingBranchesOffWithoutNeed) {
  const auto size = [](const ContourArea& contour_area, const LevelGroups::ContoursAt& contours) {
    const auto groups = LevelGroups::Make(contour_area, kParams, contours, RunContext(1));
    EXPECT_TRUE(groups.ok());
    return groups->size();
  };
  // The same needs on both; contours that run over both, as high as it goes or nearly; no contours at hand.
  EXPECT_EQ(size(Forked(kFlat), ContoursForkedAt(10.0)), 1u);
  EXPECT_EQ(size(Forked(0.8 * kFlat), ContoursForkedAt(20.0)), 1u);
  EXPECT_EQ(size(Forked(0.8 * kFlat), ContoursForkedAt(18.0)), 1u);
  EXPECT_EQ(size(Forked(0.8 * kFlat), nullptr), 1u);
}

TEST(LevelGroups, OfNoSurface) { EXPECT_EQ(GroupsOf({}).size(), 0u); }

PatchModel Quad(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  BezierPatch patch;
  patch.degree_u = patch.degree_v = 1;
  patch.points = {a, d, b, c};
  return Single(std::move(patch));
}

ContourParams SteepParams(double scallop = 0.01) {
  ContourParams params;
  params.pass.scallop = scallop;
  params.pass.window.min = Radians(45.0);
  params.pass.floor_z = 0.0;
  return params;
}

std::vector<CutterPath> ContoursOf(const PatchModel& model) {
  const Surface surface = JoinedSurface(model);
  auto result = ContourPaths(Locator(surface, 3.0), SteepParams(), RunContext(2));
  EXPECT_TRUE(result.ok()) << result.status();
  return result.ok() ? std::move(result->paths) : std::vector<CutterPath>();
}

// Samples of a patch much longer than the ball lie farther apart than elsewhere.
TEST(LevelGroups, ALongPatchIsOne) {
  const double radius = 0.5;
  const Surface surface = JoinedSurface(Quad({0, 0, 0}, {200, 0, 0}, {200, 0.7, 14}, {0, 0.5, 10}));
  const Locator locator(surface, radius);
  const RunContext run(1);
  const auto contour_area = SampleContourArea(LevelContext(locator, run), SteepParams(), run);
  ASSERT_TRUE(contour_area.ok());
  const auto groups =
      LevelGroups::Make(*contour_area, {.radius = radius, .flat = 0.2, .smallest = 0.05}, nullptr, run);
  ASSERT_TRUE(groups.ok());
  EXPECT_EQ(groups->size(), 1u);
}

// An upright sheet has contours on both sides, whichever is called the upper one, and whatever stands
// beside.
TEST(LevelGroups, BothSidesOfASheet) {
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
TEST(LevelGroups, ShareLevelsWhereTheyAreTooMany) {
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

// Three bosses whose walls want different steps and whose tops and feet lie at different heights: each is
// cut as if it stood alone.
TEST(LevelGroups, BossesAreCutAsIfTheyStoodAlone) {
  const auto boss = [](double x, double base_level, double height, double draft) {
    const double top = 4.0, bottom = top + height * std::tan(draft);
    return Transformed(Turned({Line({0, base_level + height}, {top, base_level + height}),
                               Line({top, base_level + height}, {bottom, base_level}),
                               Line({bottom, base_level}, {12, base_level})}),
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
