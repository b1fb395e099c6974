// Labels of least energy against every other labelling, and what merging must keep.
#include "cam/region/merge/merge_regions.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "cam/region/merge/min_cut.h"
#include "tests/support/random.h"

namespace patchmill {
namespace {

using testing::Random;

double Energy(const std::vector<double>& cost, const std::vector<LabelPair>& pairs, unsigned ones) {
  double sum = 0.0;
  for (std::size_t i = 0; i < cost.size(); ++i) sum += ((ones >> i) & 1u) != 0 ? cost[i] : 0.0;
  for (const LabelPair& p : pairs) sum += ((ones >> p.a) & 1u) != ((ones >> p.b) & 1u) ? p.weight : 0.0;
  return sum;
}

TEST(MinCut, NoOtherSetCostsLess) {
  Random random(7);
  for (int round = 0; round < 200; ++round) {
    const int n = 2 + round % 9;
    std::vector<double> cost;
    std::vector<LabelPair> pairs;
    for (int i = 0; i < n; ++i) cost.push_back(random.Uniform(-1, 1));
    for (int i = 0; i < n; ++i) {
      for (int j = i + 1; j < n; ++j) {
        if (random.Uniform(0, 1) < 0.5) pairs.push_back({i, j, random.Uniform(0, 0.8)});
      }
    }
    const std::vector<bool> cut = MinCut(cost, pairs);
    unsigned ones = 0;
    for (int i = 0; i < n; ++i) ones |= cut[static_cast<std::size_t>(i)] ? 1u << i : 0u;
    const double least = Energy(cost, pairs, ones);
    for (unsigned other = 0; other < 1u << n; ++other) EXPECT_LE(least, Energy(cost, pairs, other) + 1e-12);
    std::reverse(pairs.begin(), pairs.end());
    EXPECT_EQ(MinCut(cost, pairs), cut);
  }
}

TEST(MinCut, TakesTheSmallestOfEqualSets) {
  EXPECT_EQ(MinCut(std::vector<double>{0.0, 0.0}, {}), (std::vector<bool>{false, false}));
  const std::vector<LabelPair> pair = {{0, 1, 1.0}};
  EXPECT_EQ(MinCut(std::vector<double>{-1.0, 1.0}, pair), (std::vector<bool>{false, false}));
  EXPECT_EQ(MinCut(std::vector<double>{-1.5, 1.0}, pair), (std::vector<bool>{true, false}));
  EXPECT_EQ(MinCut(std::vector<double>{-1.5, 0.5}, pair), (std::vector<bool>{true, true}));
}

// A strip `width` wide and 100 long that bends by `turn` across it, between two halves of a large mountain.
std::vector<RawRegion> WithStrip(double width, double turn) {
  SplitLabel mountain, basin;
  mountain.curvature = -1;
  basin.curvature = 1;
  return {{mountain, 4000, -400, -3000},
          {basin, 100 * width, 100 * turn, -75 * width},
          {mountain, 4000, -400, -3000}};
}
const std::vector<RawContact> kAlongTheStrip = {{0, 1, 100}, {1, 2, 100}};

TEST(MergeRegions, StripsGoWithTheirSidesUntilTheyTurnEnough) {
  MergeParams params;
  params.min_area = params.min_width = 0;
  // A strip gives up 2 turn a mm when it changes sides, and saves two borders.
  for (const double turn : {0.05, 0.19}) {
    const MergedRegions merged = MergeRegions(WithStrip(10, turn), kAlongTheStrip, params);
    EXPECT_EQ(merged.label.size(), 1u) << turn;
    EXPECT_EQ(merged.label[0].curvature, -1);
  }
  for (const double turn : {0.21, 0.5})
    EXPECT_EQ(MergeRegions(WithStrip(10, turn), kAlongTheStrip, params).label.size(), 3u);
}

TEST(MergeRegions, SmallRegionsJoinTheNeighbourWithTheLongestBorder) {
  MergeParams params;
  params.border_turn = params.border_slope = 0;
  params.min_area = 50;
  SplitLabel mountain, basin, neutral;
  mountain.curvature = -1;
  basin.curvature = 1;
  const std::vector<RawRegion> raw = {
      {mountain, 500, -20, -100}, {basin, 10, 2, -3}, {neutral, 500, 0, -100}};
  const MergedRegions merged =
      MergeRegions(raw, std::vector<RawContact>{{0, 1, 3}, {1, 2, 5}, {0, 2, 40}}, params);
  EXPECT_EQ(merged.group[1], merged.group[2]);
  EXPECT_NE(merged.group[1], merged.group[0]);
}

TEST(MergeRegions, NarrowRegionsJoinANeighbourHoweverLarge) {
  // A strip 300 mm long between two halves, open at its ends: 2 areas over its border is nearly its width.
  MergeParams params;
  params.border_turn = params.border_slope = params.min_area = 0;
  params.min_width = 3.0;
  SplitLabel mountain, basin;
  mountain.curvature = -1;
  basin.curvature = 1;
  for (const double width : {2.9, 3.2}) {
    const std::vector<RawRegion> raw = {
        {mountain, 9000, -900, -3000},
        {.label = basin, .area = 300 * width, .curvature = 300, .open_border = 2 * width},
        {mountain, 9000, -900, -3000}};
    const std::vector<RawContact> contacts = {{0, 1, 300}, {1, 2, 300}};
    EXPECT_EQ(MergeRegions(raw, contacts, params).label.size(), width < 3.0 ? 1u : 3u) << width;
  }
}

TEST(MergeRegions, MountainsOfDifferentSummitsKeepApartAndBasinsOfDifferentPits) {
  MergeParams params;
  params.min_area = params.min_width = 0;
  SplitLabel mountain, basin;
  mountain.curvature = -1;
  basin.curvature = 1;
  // A mountain and a basin, each in four parts of two summits and two pits.
  std::vector<RawRegion> raw;
  std::vector<RawContact> contacts;
  for (int k = 0; k < 8; ++k) {
    const bool up = k < 4;
    raw.push_back({.label = up ? mountain : basin,
                   .area = 500,
                   .curvature = up ? -60.0 : 60.0,
                   .whole = up ? 0 : 4,
                   .summit = k % 2,
                   .pit = k / 2 % 2});
    if (k % 4 > 0) contacts.push_back({k - 1, k, 10});
  }
  contacts.push_back({3, 0, 10});  // rings
  contacts.push_back({7, 4, 10});
  contacts.push_back({0, 2, 10});
  contacts.push_back({1, 3, 10});
  contacts.push_back({4, 6, 10});
  contacts.push_back({5, 7, 10});
  contacts.push_back({0, 4, 30});
  const MergedRegions merged = MergeRegions(raw, contacts, params);
  EXPECT_EQ(merged.label.size(), 4u);
  for (std::size_t i = 0; i < 8; ++i) {
    for (std::size_t j = 0; j < 8; ++j) {
      const bool one = i / 4 == j / 4 && (i < 4 ? raw[i].summit == raw[j].summit : raw[i].pit == raw[j].pit);
      EXPECT_EQ(merged.group[i] == merged.group[j], one) << i << " " << j;
    }
  }
}

TEST(MergeRegions, PartsOfOneWholeGetOneLabel) {
  // Part 1 alone would go with the basin around it: it bends too little for its border. The whole does not.
  MergeParams params;
  params.min_area = params.min_width = 0;
  SplitLabel mountain, basin;
  mountain.curvature = -1;
  basin.curvature = 1;
  const std::vector<RawRegion> raw = {
      {.label = mountain, .area = 900, .curvature = -90, .whole = 0, .summit = 0},
      {.label = mountain, .area = 900, .curvature = -2, .whole = 0, .summit = 1},
      {.label = basin, .area = 900, .curvature = 90}};
  const std::vector<RawContact> contacts = {{0, 1, 5}, {1, 2, 60}, {0, 2, 60}};
  const MergedRegions merged = MergeRegions(raw, contacts, params);
  EXPECT_EQ(merged.label.size(), 3u);
  EXPECT_EQ(merged.label[static_cast<std::size_t>(merged.group[1])].curvature, -1);
}

// Domes on a plane that have no border with it in the split, in any order. The domes of one label are one
// region; it never happens that one of them joins the plane and the other three do not. Tiny parts are no
// region.
TEST(MergeRegions, IslandsOfOneLabelAreOneRegion) {
  SplitLabel level, dome, pit;
  dome.curvature = -1;
  pit.curvature = 1;
  std::vector<RawRegion> raw = {{level, 3600, 0, -500}};
  for (const double noise : {0.0, 1e-9, -1e-9, 0.0}) raw.push_back({dome, 42 + noise, -20, -30});
  raw.push_back({pit, 1.0, 5, -0.5});
  std::vector<std::size_t> order(raw.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  do {
    std::vector<RawRegion> turned;
    for (const std::size_t k : order) turned.push_back(raw[k]);
    const MergedRegions merged = MergeRegions(turned, {}, MergeParams());
    ASSERT_EQ(merged.label.size(), 2u);
    for (std::size_t k = 0; k < order.size(); ++k) {
      const SplitLabel& label = merged.label[static_cast<std::size_t>(merged.group[k])];
      ASSERT_EQ(label.curvature, order[k] == 0 || order[k] == 5 ? 0 : -1);
    }
  } while (std::next_permutation(order.begin(), order.end()));
  // With a large one of their kind they go with that; with no large one at all, each kind is a region.
  raw[0].label = dome;
  raw[0].curvature = -500;
  MergedRegions merged = MergeRegions(raw, {}, MergeParams());
  EXPECT_EQ(merged.label.size(), 1u);
  raw = {{dome, 30, -20, -9}, {pit, 40, 20, -9}, {dome, 20, -20, -9}};
  merged = MergeRegions(raw, {}, MergeParams());
  EXPECT_EQ(merged.group, (std::vector<int>{0, 1, 0}));
}

TEST(MergeRegions, NoMoreThanAskedForAndTheLargestStay) {
  MergeParams params;
  params.border_turn = params.border_slope = 0;
  params.min_area = 0;
  params.max_regions = 5;
  std::vector<RawRegion> raw;
  std::vector<RawContact> contacts;
  for (int i = 0; i < 30; ++i) {
    SplitLabel label;
    label.curvature = static_cast<std::int8_t>(i % 2 == 0 ? -1 : 1);
    const double area = 10 + (i * 7) % 30;
    raw.push_back({label, area, label.curvature * area, -area});
    if (i > 0) contacts.push_back({i - 1, i, 5.0});
  }
  const MergedRegions merged = MergeRegions(raw, contacts, params);
  EXPECT_LE(merged.label.size(), 5u);
  EXPECT_GE(merged.label.size(), 2u);
}

TEST(MergeRegions, HoweverManySteepAreaNeverGoesWithGentle) {
  // Twelve bosses apart, each a wall and a top: two labels, two regions, and each has all of its label.
  MergeParams params;
  params.max_regions = 20;
  SplitLabel wall, top;
  wall.steep = true;
  wall.curvature = top.curvature = -1;
  std::vector<RawRegion> raw;
  std::vector<RawContact> contacts;
  for (int i = 0; i < 12; ++i) {
    raw.push_back({wall, 1500.0 + 1e-6 * i, -200, 900});
    raw.push_back({top, 700.0 - 1e-6 * i, -90, -400});
    raw.back().summit = raw[raw.size() - 2].summit = i;
    contacts.push_back({2 * i, 2 * i + 1, 60.0});
  }
  MergedRegions merged = MergeRegions(raw, contacts, params);
  EXPECT_LE(merged.label.size(), 20u);
  for (std::size_t i = 0; i < raw.size(); ++i)
    EXPECT_EQ(merged.label[static_cast<std::size_t>(merged.group[i])].steep, raw[i].label.steep) << i;
  for (int i = 1; i < 12; ++i)  // equal ones are treated alike
    EXPECT_EQ(merged.group[static_cast<std::size_t>(2 * i + 1)], merged.group[1]) << i;
  // As many as there are labels stay.
  params.max_regions = 1;
  merged = MergeRegions(raw, contacts, params);
  EXPECT_EQ(merged.label.size(), 2u);
}

TEST(MergeRegions, CrumbsTakeNoPlaceOfLargerRegions) {
  // Ten tiny parts in an unreachable area, and a chain of five regions. Five are allowed.
  MergeParams params;
  params.max_regions = 5;
  params.border_turn = params.border_slope = 0;
  std::vector<RawRegion> raw;
  std::vector<RawContact> contacts;
  for (int i = 0; i < 5; ++i) {
    SplitLabel label;
    label.curvature = static_cast<std::int8_t>(i % 2 == 0 ? -1 : 1);
    raw.push_back({label, 200.0 + i, label.curvature * 50.0, -100});
    if (i > 0) contacts.push_back({i - 1, i, 20.0});
  }
  SplitLabel undercut;
  undercut.reason = UnreachableReason::kUndercut;
  raw.push_back({undercut, 900, 0, 0});
  for (int i = 0; i < 10; ++i) {
    SplitLabel label;
    label.steep = i % 2 == 0;
    raw.push_back({label, 0.01, 0, label.steep ? 0.01 : -0.01});
    contacts.push_back({5, 6 + i, 0.4});
  }
  const MergedRegions merged = MergeRegions(raw, contacts, params);
  std::set<int> chain(merged.group.begin(), merged.group.begin() + 5);
  EXPECT_EQ(chain.size(), 5u);
}

TEST(MergeRegions, SliversOfAReasonGoWithTheReasonBesideThem) {
  SplitLabel gentle, undercut, floor;
  undercut.reason = UnreachableReason::kUndercut;
  floor.reason = UnreachableReason::kFloor;
  // 100 mm long, between the two: 0.001 mm wide, then 0.1.
  for (const double width : {0.001, 0.1}) {
    const std::vector<RawRegion> raw = {
        {gentle, 900, 0, -500}, {undercut, 900, 0, 0}, {floor, 100 * width, 0, 0}};
    const std::vector<RawContact> contacts = {{0, 2, 100}, {1, 2, 100}};
    const MergedRegions merged = MergeRegions(raw, contacts, MergeParams());
    EXPECT_EQ(merged.group[1] == merged.group[2], width < 0.01) << width;
    EXPECT_NE(merged.group[0], merged.group[1]);
    EXPECT_EQ(merged.label[static_cast<std::size_t>(merged.group[1])].reason, UnreachableReason::kUndercut);
  }
}

TEST(MergeRegions, WhatIsNotReachedKeepsApartByReason) {
  SplitLabel gentle, concave, undercut;
  concave.reason = UnreachableReason::kConcave;
  undercut.reason = UnreachableReason::kUndercut;
  const std::vector<RawRegion> raw = {
      {gentle, 900, 0, -500}, {concave, 3, 0, 0}, {concave, 4, 0, 0}, {undercut, 900, 0, 0}};
  const std::vector<RawContact> contacts = {{0, 1, 5}, {0, 2, 5}, {0, 3, 50}, {1, 3, 2}};
  const MergedRegions merged = MergeRegions(raw, contacts, MergeParams());
  ASSERT_EQ(merged.label.size(), 3u);
  EXPECT_EQ(merged.group[1], merged.group[2]);
  for (std::size_t i = 0; i < raw.size(); ++i)
    EXPECT_EQ(merged.label[static_cast<std::size_t>(merged.group[i])].reason, raw[i].label.reason);
}

}  // namespace
}  // namespace patchmill
