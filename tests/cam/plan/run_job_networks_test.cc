// Nets drawn by hand and a net with T-junctions, joined, through the whole chain: verified, and judged from
// the program's text.
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/joining/join_network.h"
#include "core/joining/network_findings.h"
#include "tests/support/drawn_nets.h"
#include "tests/support/jobs/jobs.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

const char* const kFolder = PATCHMILL_SOURCE_DIR "/tests/models/networks";

// Mills a network with a ball; `least_reachable` is the share of the area the ball must reach.
void ExpectMilled(const CurveNetwork& network, UpAxis up, double radius, double least_reachable) {
  const JoinedNetwork joined = JoinNetwork(network);
  ASSERT_FALSE(HasError(joined.findings)) << joined.findings[0].message;
  Job job = BallJob(radius);
  job.setup.placement.up = up;
  job.operation.scallop = 0.1;
  job.operation.tolerance = 0.02;
  const Surface surface = PlacedSurface(joined.model, job.setup);
  const JobResult result = Mill(surface, job);
  Random random(5);
  CheckProgram(surface, job, result, random, kSanitized ? 50 : 300);
  EXPECT_GT(result.report.verify.reachable_area, least_reachable * result.report.verify.total_area)
      << Describe(result);
}

// A little of the left side looks down.
TEST(DrawnNetwork, MouseIsMilled) { ExpectMilled(DrawnMouse(kFolder), UpAxis::kY, 2.0, 0.8); }

// A side of 30 mm meets three of 8 to 12 mm at two vertices on it.
TEST(TJunctions, AreMilledAsIfThereWereNone) {
  CurveNetwork n;
  const auto wave = [](double x, double y) -> Vec3 {
    return {x, y, 3 * std::sin(0.15 * x + 0.1 * y) + 2 * std::cos(0.12 * y)};
  };
  for (const auto& [x, y] : {std::pair(-12, 0), std::pair(0, 0), std::pair(0, 30), std::pair(-12, 30),
                             std::pair(14, 0), std::pair(14, 30), std::pair(14, 8), std::pair(14, 20)}) {
    n.vertices.push_back({"", wave(x, y), {}});
  }
  for (const double at : {0.3, 0.65}) n.vertices.emplace_back().on_edge = {1, 2, at};
  for (const std::vector<int>& loop :
       std::vector<std::vector<int>>{{0, 1, 2, 3}, {1, 4, 6, 8}, {8, 6, 7, 9}, {9, 7, 5, 2}}) {
    n.faces.push_back({"", loop, PatchScheme::kAuto, {}});
  }
  ExpectMilled(n, UpAxis::kZ, 2.0, 0.99);
}

}  // namespace
}  // namespace patchmill
