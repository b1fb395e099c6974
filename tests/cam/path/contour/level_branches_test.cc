// Areas that branch upwards, on walls with towers.
#include "cam/path/contour/level_branches.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace patchmill {
namespace {

constexpr double kSpacing = 0.5, kReach = 1.5;

// Samples of the plane y = 0 over [x0, x1] x [z0, z1].
void AddWall(double x0, double x1, double z0, double z1, ContourArea& contour_area) {
  const int nx = static_cast<int>(std::round((x1 - x0) / kSpacing)),
            nz = static_cast<int>(std::round((z1 - z0) / kSpacing));
  for (int i = 0; i < nx; ++i) {
    for (int k = 0; k < nz; ++k) {
      ContourSample sample;
      sample.contact = Vec3(x0 + (i + 0.5) * kSpacing, 0.0, z0 + (k + 0.5) * kSpacing);
      sample.center = sample.contact - 3.0 * Vec3::UnitY();
      sample.above = sample.below = 0.5 * kSpacing;
      sample.width = kSpacing;
      contour_area.samples.push_back(sample);
    }
  }
  contour_area.spacing = kSpacing;
}

std::vector<LevelBranch> BranchesOf(const ContourArea& contour_area, double rise = 3.0) {
  const std::vector<std::size_t> one_set(contour_area.samples.size(), 0);
  auto branches = FindBranches(contour_area, one_set, {.reach = kReach, .rise = rise}, RunContext(1));
  EXPECT_TRUE(branches.ok());
  return *std::move(branches);
}

double LeastX(const ContourArea& contour_area, const LevelBranch& branch) {
  double least = kInfinity;
  for (const std::size_t i : branch.samples) least = std::min(least, contour_area.samples[i].contact.x());
  return least;
}

TEST(LevelBranches, AreTheSmallerSidesOfForks) {
  ContourArea contour_area;
  AddWall(0, 60, 0, 10, contour_area);    // the foot of all
  AddWall(0, 20, 10, 30, contour_area);   // the trunk
  AddWall(30, 60, 10, 15, contour_area);  // beside it, with two towers
  AddWall(30, 36, 15, 25, contour_area);
  AddWall(45, 60, 15, 25, contour_area);
  const std::vector<LevelBranch> branches = BranchesOf(contour_area);
  ASSERT_EQ(branches.size(), 2u);
  // Nothing is missed by more than the cubes that are looked at.
  const double exact = 2.0 * kReach;
  EXPECT_NEAR(branches[0].area, 6 * 10, 6 * exact);
  EXPECT_NEAR(branches[0].base_level, 15.0, exact);
  EXPECT_GE(LeastX(contour_area, branches[0]), 30.0);
  EXPECT_NEAR(branches[1].area, 30 * 5 + 21 * 10, 30 * exact);
  EXPECT_NEAR(branches[1].base_level, 10.0, exact);
  EXPECT_GE(LeastX(contour_area, branches[1]), 30.0);
  // The first stands on the second, which stands on the trunk.
  const auto has = [&](const LevelBranch& branch, std::size_t i) {
    return std::find(branch.samples.begin(), branch.samples.end(), i) != branch.samples.end();
  };
  EXPECT_TRUE(has(branches[1], branches[0].from));
  EXPECT_FALSE(has(branches[0], branches[1].from));
  EXPECT_LT(contour_area.samples[branches[1].from].contact.x(), 20.0);
  for (const LevelBranch& branch : branches) {
    for (const std::size_t i : branch.samples)
      EXPECT_GE(contour_area.samples[i].center.z(), branch.base_level);
  }
  for (const std::size_t i : branches[0].samples) EXPECT_FALSE(has(branches[1], i));
}

TEST(LevelBranches, RiseFarEnough) {
  ContourArea contour_area;
  AddWall(0, 20, 0, 20, contour_area);
  AddWall(20, 40, 0, 10, contour_area);
  AddWall(30, 40, 10, 15, contour_area);
  EXPECT_EQ(BranchesOf(contour_area, 2.0).size(), 1u);
  EXPECT_EQ(BranchesOf(contour_area, 5.5).size(), 0u);
}

// Around an outer corner only the contacts meet, in a slot only the centres; along a patch longer than the
// ball neighbours alone tell.
TEST(LevelBranches, WhatHangsTogetherIsNoBranch) {
  for (const int by : {0, 1, 2}) {
    ContourArea contour_area;
    AddWall(0, 20, 0, 20, contour_area);
    const std::size_t first = contour_area.samples.size();
    AddWall(20, 40, 0, 20, contour_area);
    for (std::size_t i = first; i < contour_area.samples.size(); ++i) {
      if (by != 0) contour_area.samples[i].contact.y() += 50.0;
      if (by != 1) contour_area.samples[i].center.y() += 50.0;
    }
    for (std::size_t i = first; by == 2 && i < contour_area.samples.size(); ++i)
      contour_area.neighbors.emplace_back(i - first, i);
    EXPECT_EQ(BranchesOf(contour_area).size(), 0u) << by;
  }
}

TEST(LevelBranches, GrowOnNoOtherSet) {
  ContourArea contour_area;
  AddWall(0, 20, 0, 20, contour_area);
  std::vector<std::size_t> sets(contour_area.samples.size(), 0);
  AddWall(20, 30, 0, 10, contour_area);
  AddWall(25, 30, 10, 20, contour_area);
  EXPECT_EQ(BranchesOf(contour_area).size(), 1u);
  sets.resize(contour_area.samples.size(), 1);
  const auto apart = FindBranches(contour_area, sets, {.reach = kReach, .rise = 3.0}, RunContext(1));
  ASSERT_TRUE(apart.ok());
  EXPECT_TRUE(apart->empty());
}

TEST(LevelBranches, OfNoSurface) { EXPECT_TRUE(BranchesOf({}).empty()); }

TEST(LevelBranches, CancelIsObeyed) {
  ContourArea contour_area;
  AddWall(0, 20, 0, 20, contour_area);
  RunContext stopped(1);
  stopped.Cancel();
  const std::vector<std::size_t> one_set(contour_area.samples.size(), 0);
  EXPECT_EQ(FindBranches(contour_area, one_set, {.reach = kReach}, stopped).status().code(),
            absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace patchmill
