// Where ground parts upwards, against walls with towers.
#include "cam/path/level_branches.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace patchmill {
namespace {

constexpr double kSpacing = 0.5, kReach = 1.5;

// Samples of the plane y = 0 over [x0, x1] x [z0, z1].
void AddWall(double x0, double x1, double z0, double z1, ContourGround& ground) {
  const int nx = static_cast<int>(std::round((x1 - x0) / kSpacing)),
            nz = static_cast<int>(std::round((z1 - z0) / kSpacing));
  for (int i = 0; i < nx; ++i) {
    for (int k = 0; k < nz; ++k) {
      ContourSample sample;
      sample.contact = Vec3(x0 + (i + 0.5) * kSpacing, 0.0, z0 + (k + 0.5) * kSpacing);
      sample.center = sample.contact - 3.0 * Vec3::UnitY();
      sample.up = sample.down = 0.5 * kSpacing;
      sample.width = kSpacing;
      ground.samples.push_back(sample);
    }
  }
  ground.spacing = kSpacing;
}

std::vector<LevelBranch> BranchesOf(const ContourGround& ground, double rise = 3.0) {
  const std::vector<std::size_t> one_set(ground.samples.size(), 0);
  auto branches = FindBranches(ground, one_set, {.reach = kReach, .rise = rise}, RunContext(1));
  EXPECT_TRUE(branches.ok());
  return *std::move(branches);
}

double LeastX(const ContourGround& ground, const LevelBranch& branch) {
  double least = kInfinity;
  for (const std::size_t i : branch.samples) least = std::min(least, ground.samples[i].contact.x());
  return least;
}

TEST(LevelBranches, AreTheSmallerSidesOfForks) {
  ContourGround ground;
  AddWall(0, 60, 0, 10, ground);    // the foot of all
  AddWall(0, 20, 10, 30, ground);   // the trunk
  AddWall(30, 60, 10, 15, ground);  // beside it, with two towers
  AddWall(30, 36, 15, 25, ground);
  AddWall(45, 60, 15, 25, ground);
  const std::vector<LevelBranch> branches = BranchesOf(ground);
  ASSERT_EQ(branches.size(), 2u);
  // Nothing is missed by more than the cubes that are looked at.
  const double exact = 2.0 * kReach;
  EXPECT_NEAR(branches[0].area, 6 * 10, 6 * exact);
  EXPECT_NEAR(branches[0].foot, 15.0, exact);
  EXPECT_GE(LeastX(ground, branches[0]), 30.0);
  EXPECT_NEAR(branches[1].area, 30 * 5 + 21 * 10, 30 * exact);
  EXPECT_NEAR(branches[1].foot, 10.0, exact);
  EXPECT_GE(LeastX(ground, branches[1]), 30.0);
  // The first stands on the second, which stands on the trunk.
  const auto has = [&](const LevelBranch& branch, std::size_t i) {
    return std::find(branch.samples.begin(), branch.samples.end(), i) != branch.samples.end();
  };
  EXPECT_TRUE(has(branches[1], branches[0].from));
  EXPECT_FALSE(has(branches[0], branches[1].from));
  EXPECT_LT(ground.samples[branches[1].from].contact.x(), 20.0);
  for (const LevelBranch& branch : branches) {
    for (const std::size_t i : branch.samples) EXPECT_GE(ground.samples[i].center.z(), branch.foot);
  }
  for (const std::size_t i : branches[0].samples) EXPECT_FALSE(has(branches[1], i));
}

TEST(LevelBranches, RiseFarEnough) {
  ContourGround ground;
  AddWall(0, 20, 0, 20, ground);
  AddWall(20, 40, 0, 10, ground);
  AddWall(30, 40, 10, 15, ground);
  EXPECT_EQ(BranchesOf(ground, 2.0).size(), 1u);
  EXPECT_EQ(BranchesOf(ground, 5.5).size(), 0u);
}

// Around an outer corner only the contacts meet, in a slot only the centres; along a patch longer than the
// ball neighbours alone tell.
TEST(LevelBranches, WhatHangsTogetherIsNoBranch) {
  for (const int by : {0, 1, 2}) {
    ContourGround ground;
    AddWall(0, 20, 0, 20, ground);
    const std::size_t first = ground.samples.size();
    AddWall(20, 40, 0, 20, ground);
    for (std::size_t i = first; i < ground.samples.size(); ++i) {
      if (by != 0) ground.samples[i].contact.y() += 50.0;
      if (by != 1) ground.samples[i].center.y() += 50.0;
    }
    for (std::size_t i = first; by == 2 && i < ground.samples.size(); ++i)
      ground.neighbors.emplace_back(i - first, i);
    EXPECT_EQ(BranchesOf(ground).size(), 0u) << by;
  }
}

TEST(LevelBranches, GrowOnNoOtherSet) {
  ContourGround ground;
  AddWall(0, 20, 0, 20, ground);
  std::vector<std::size_t> sets(ground.samples.size(), 0);
  AddWall(20, 30, 0, 10, ground);
  AddWall(25, 30, 10, 20, ground);
  EXPECT_EQ(BranchesOf(ground).size(), 1u);
  sets.resize(ground.samples.size(), 1);
  const auto apart = FindBranches(ground, sets, {.reach = kReach, .rise = 3.0}, RunContext(1));
  ASSERT_TRUE(apart.ok());
  EXPECT_TRUE(apart->empty());
}

TEST(LevelBranches, OfNoGround) { EXPECT_TRUE(BranchesOf({}).empty()); }

TEST(LevelBranches, CancelIsObeyed) {
  ContourGround ground;
  AddWall(0, 20, 0, 20, ground);
  RunContext stopped(1);
  stopped.Cancel();
  const std::vector<std::size_t> one_set(ground.samples.size(), 0);
  EXPECT_EQ(FindBranches(ground, one_set, {.reach = kReach}, stopped).status().code(),
            absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace patchmill
