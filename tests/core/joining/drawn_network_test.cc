// Nets drawn by hand in three dimensions (curves only) become joined surfaces.
#include <set>

#include <gtest/gtest.h>

#include "core/joining/continuity.h"
#include "core/joining/join_network.h"
#include "tests/support/drawn_nets.h"

namespace patchmill {
namespace {

const char* const kFolder = PATCHMILL_SOURCE_DIR "/tests/models/networks";

TEST(DrawnNetwork, BecomesAClosedJoinedSurface) {
  const CurveNetwork network = testing::DrawnWedge(kFolder);
  const JoinedNetwork joined = JoinNetwork(network);
  for (const Diagnostic& d : joined.findings) ADD_FAILURE() << d.code << ": " << d.message;
  ASSERT_EQ(joined.model.patches.size(), 9u);
  auto checked = BuildNetwork(joined.model);
  ASSERT_TRUE(checked.ok());
  EXPECT_EQ(checked->open_edge_count, 0);
  EXPECT_EQ(checked->euler_characteristic, 2);
  const auto report = MeasureContinuity(*checked, 300, RunContext(1));
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(report->edges.size(), 17u);
  std::set<std::pair<int, int>> smooth;
  for (const EdgeContinuity& joint : report->edges) {
    EXPECT_LE(joint.max_gap, 1e-10);
    if (joint.max_angle <= 1e-6) {
      smooth.emplace(joint.a.patch.value, joint.b.patch.value);
      EXPECT_LE(joint.max_angle, 1e-10);
    }
  }
  EXPECT_EQ(smooth, (std::set<std::pair<int, int>>{{3, 4}, {5, 6}, {7, 8}}));
}

TEST(DrawnNetwork, AMouseIsSmoothButForItsShoulder) {
  const JoinedNetwork joined = JoinNetwork(testing::DrawnMouse(kFolder));
  for (const Diagnostic& d : joined.findings) ADD_FAILURE() << d.code << ": " << d.message;
  ASSERT_EQ(joined.model.patches.size(), 21u);
  auto checked = BuildNetwork(joined.model);
  ASSERT_TRUE(checked.ok());
  EXPECT_EQ(checked->open_edge_count, 10);
  EXPECT_EQ(checked->part_links.size(), 4u);
  const auto report = MeasureContinuity(*checked, 300, RunContext(1));
  ASSERT_TRUE(report.ok());
  EXPECT_EQ(report->edges.size(), 36u);
  std::set<std::pair<int, int>> creases;
  for (const EdgeContinuity& joint : report->edges) {
    EXPECT_LE(joint.max_gap, 1e-11);
    if (joint.max_angle > 1e-6) creases.emplace(joint.a.patch.value, joint.b.patch.value);
  }
  EXPECT_EQ(creases, (std::set<std::pair<int, int>>{{3, 15}, {4, 16}, {5, 17}}));
}

}  // namespace
}  // namespace patchmill
