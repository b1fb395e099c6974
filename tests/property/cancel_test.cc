// Every long computation stops within 0.2 s of a cancel, at any moment.
#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "cam/location/locator.h"
#include "cam/path/contour/contour_paths.h"
#include "cam/path/parallel/zigzag_paths.h"
#include "cam/path/rest/leftover_spots.h"
#include "cam/path/rest/redundant_passes.h"
#include "cam/path/rest/rest_passes.h"
#include "cam/plan/beside_part.h"
#include "cam/region/figures/reach_table.h"
#include "cam/region/split_regions.h"
#include "core/joining/join_network.h"
#include "core/lines/flow_lines.h"
#include "core/lines/line_family.h"
#include "core/lines/zero_curves.h"
#include "core/network/patch_network.h"
#include "core/surface/extent.h"
#include "tests/support/cancel_latency.h"
#include "tests/support/jobs/jobs.h"
#include "tests/support/sanitized.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using testing::PlacedSurface;
using testing::SurfaceOf;

// Sanitizers make everything ten times slower: smaller parts then, no other code.
int Size(int full, int sanitized) { return testing::kSanitized ? sanitized : full; }

// A random part of that many spans each way; sanitized, a third of them.
PatchModel RandomPart(std::uint64_t seed, int spans, double size) {
  const int used = Size(spans, std::max(3, spans / 3));
  return testing::RandomBspline(seed, {.spans = used, .size = size * used / spans});
}

// Expects that `work` reports its progress twice a second, and that it stops when it is cancelled at each of
// `count` moments. Times are processor time.
void ExpectStops(const std::function<absl::Status(const RunContext&)>& work, int count = 6) {
  constexpr double kLatency = testing::kSanitized ? 3.0 : 0.2, kSilence = testing::kSanitized ? 10.0 : 0.5;
  const auto now = [] { return testing::ClockSeconds(CLOCK_THREAD_CPUTIME_ID); };
  const double start = now();
  double reported = start, throttle = 0.0;
  std::string stage = "the start", after;
  const auto report = [&](std::string_view at, double) {
    if (now() - reported > throttle) {
      throttle = now() - reported;
      after = stage;
    }
    reported = now();
    stage = at;
  };
  RunContext whole(1);
  whole.set_progress(report);
  ASSERT_TRUE(work(whole).ok());
  report("the end", 1.0);
  const double all = now() - start;
  EXPECT_LE(throttle, kSilence) << "nothing said after " << after;
  ::testing::Test::RecordProperty("silence after " + after, std::to_string(throttle));

  if (testing::kSanitized) count = 2;
  int stopped = 0;
  double longest = 0.0;
  for (int k = 0; k < count; ++k) {
    const double after_seconds = (k + 0.5) / count * all;
    const testing::CancelLatency latency = testing::CancelAfter(after_seconds, work);
    EXPECT_LE(latency.seconds, kLatency) << "cancelled " << after_seconds << " s after the start, of " << all;
    if (latency.status.code() == absl::StatusCode::kCancelled) ++stopped;
    longest = std::max(longest, latency.seconds);
  }
  ::testing::Test::RecordProperty("longest latency, of " + std::to_string(all), std::to_string(longest));
  EXPECT_GE(stopped, count / 2);
}

PatchModel Waves(int side) {
  PatchModel model;
  const auto at = [](int i, int j) {
    return Vec3(2.0 * i, 2.0 * j, 3.0 * std::sin(0.62 * i) * std::cos(0.54 * j));
  };
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      model.patches.push_back(
          {"", testing::Bilinear(at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1))});
    }
  }
  return model;
}

// Five metres long, four millimetres wide: lines of ten thousand samples.
PatchModel LongPart() {
  return testing::Single(testing::InterpolatedHeights(
      [](double x, double y) { return 3.0 * std::sin(0.31 * x) * std::cos(0.2 * y); }, 0.0, Size(5000, 500),
      0.0, 4.0, Size(1000, 100), 3));
}

PatchModel BumpyPart() { return testing::kSanitized ? RandomPart(7, 18, 40.0) : testing::Bumpy(); }

TEST(Cancel, Adjacency) {
  const PatchModel model = Waves(Size(200, 60));
  ExpectStops([&](const RunContext& run) { return BuildNetwork(model, run).status(); });
}

// Each row half a patch beside the last: T-junctions everywhere.
TEST(Cancel, AdjacencyOfPatchesThatDoNotMeet) {
  const int side = Size(100, 40);
  PatchModel model = Waves(side);
  for (std::size_t i = 0; i < model.patches.size(); ++i) {
    for (Vec3& p : std::get<BezierPatch>(model.patches[i].shape).points) {
      p.y() += static_cast<double>((i / static_cast<std::size_t>(side)) % 2);
    }
  }
  ExpectStops([&](const RunContext& run) { return BuildNetwork(model, run).status(); });
}

TEST(Cancel, PlacedModels) {
  const PatchModel model = Waves(Size(150, 40));
  ExpectStops([&](const RunContext& run) { return BuildPlacedSurface(model, {}, run).status(); });
}

TEST(Cancel, Surface) {
  PatchNetwork network;
  network.model = BumpyPart();
  ExpectStops(
      [&](const RunContext& run) { return BuildSurface(network, {.leaf_thickness = 1e-3}, run).status(); });
}

TEST(Cancel, ManyPatches) {
  PatchNetwork network;
  network.model = Waves(Size(300, 80));
  constexpr int kMoments = 6;
  // Made beforehand: a copy takes a tenth of a second.
  std::vector<PatchNetwork> copies(kMoments + 1, network);
  const auto build = [&](const RunContext& run) {
    PatchNetwork own = std::move(copies.back());
    copies.pop_back();
    return BuildSurface(std::move(own), {}, run).status();
  };
  ExpectStops(build, kMoments);
}

TEST(Cancel, Locator) {
  const Surface surface = SurfaceOf(BumpyPart());
  ExpectStops([&](const RunContext& run) { return Locator::Make(surface, 0.6, run).status(); });
}

TEST(Cancel, Zigzag) {
  const Surface surface = PlacedSurface(LongPart());
  const Locator locator(surface, 2.0);
  ZigzagParams params;
  params.pass.scallop = 0.1;
  params.pass.chord_tolerance = 0.02;
  ExpectStops([&](const RunContext& run) { return ZigzagPaths(locator, params, run).status(); });
}

TEST(Cancel, Contours) {
  const Surface surface = PlacedSurface(RandomPart(7, 12, 50.0));
  const Locator locator(surface, 2.0);
  ContourParams params;
  params.pass.scallop = 0.1;
  params.pass.chord_tolerance = 0.02;
  ExpectStops([&](const RunContext& run) { return ContourPaths(locator, params, run).status(); });
}

RestPassParams CoarseCoverage() {
  RestPassParams params;
  params.pass.scallop = 0.05;
  params.limit = 0.06;
  return params;
}

TEST(Cancel, RestPasses) {
  const Surface surface = PlacedSurface(RandomPart(7, 8, 40.0));
  const Locator locator(surface, 2.0);
  const RestPassParams params = CoarseCoverage();
  const Locator reach = *ReachLocator(locator, params, RunContext());
  ExpectStops([&](const RunContext& run) { return RestPaths(locator, reach, {}, params, run).status(); });
}

TEST(Cancel, RedundantPasses) {
  const Surface surface = PlacedSurface(RandomPart(7, 8, 40.0));
  const Locator locator(surface, 2.0);
  const RestPassParams params = CoarseCoverage();
  const Locator reach = *ReachLocator(locator, params, RunContext());
  ZigzagParams lines;
  lines.pass.scallop = params.pass.scallop;
  std::vector<CutterPath> paths = *ZigzagPaths(locator, lines, RunContext());
  lines.angle = 1.0;
  const std::vector<CutterPath> across = *ZigzagPaths(locator, lines, RunContext());
  paths.insert(paths.end(), across.begin(), across.end());
  ExpectStops([&](const RunContext& run) {
    return RemoveRedundantPasses(locator, reach, paths, {params}, run).status();
  });
}

TEST(Cancel, Regions) {
  const Surface surface = PlacedSurface(RandomPart(7, 25, 60.0));
  ExpectStops([&](const RunContext& run) { return SplitRegions(surface, {}, run).status(); });
}

TEST(Cancel, ReachOfManyBalls) {
  const Surface surface = PlacedSurface(RandomPart(7, 8, 40.0));
  ExpectStops([&](const RunContext& run) {
    return ReachTable(surface, {.radii = {0.5, 1.0, 2.0, 3.0, 5.0}}, run).status();
  });
}

// What the part covers, seen from above.
TEST(Cancel, BesideStrips) {
  PatchModel model = RandomPart(7, 40, 40.0);
  model.patches.push_back(
      {"", testing::Bilinear(Vec3(0, 0, -9), Vec3(40, 0, -9), Vec3(0, 0, 0), Vec3(40, 0, 0))});
  const Surface surface = SurfaceOf(model);
  ExpectStops([&](const RunContext& run) { return FindBesideStrips(surface, {}, run).status(); });
}

TEST(Cancel, Jobs) {
  const Surface surface = PlacedSurface(RandomPart(5, 8, 40.0));
  Job job = testing::BallJob(2.0);
  job.operation.scallop = 0.02;
  ExpectStops([&](const RunContext& run) { return RunJob(surface, job, run).status(); }, 12);
}

// One patch is the whole part: nothing to go round, everything inside.
TEST(Cancel, OnePatch) {
  const PatchModel hull =
      testing::Single(testing::RandomBezier(3, Size(15, 7), Size(15, 7), true, Size(100, 20)));
  PatchNetwork network;
  network.model = hull;
  ExpectStops(
      [&](const RunContext& run) { return BuildSurface(network, {.leaf_thickness = 1e-3}, run).status(); });
  const Surface surface = PlacedSurface(hull);
  ExpectStops([&](const RunContext& run) { return Locator::Make(surface, 0.3, run).status(); });
  ExpectStops([&](const RunContext& run) { return SplitRegions(surface, {}, run).status(); });
  ExpectStops([&](const RunContext& run) {
    return ReachTable(surface, {.radii = {0.5, 1.0, 2.0, 3.0, 5.0}}, run).status();
  });
  const ZeroField field = FieldOf(ContourInflectionLines(), 0.0);
  ExpectStops([&](const RunContext& run) {
    return TraceZeroCurves(surface, field, ZeroMeshParams(), 1e-4, run).status();
  });
}

// Planes: one leaf each.
TEST(Cancel, OneLeaf) {
  const Surface surface = PlacedSurface(testing::Plane(50.0, 0.0, 0.2, 0.1));
  Job job = testing::BallJob(2.0);
  job.operation.scallop = 0.01;
  ExpectStops([&](const RunContext& run) { return RunJob(surface, job, run).status(); });
  const Locator locator(surface, 2.0);
  const RestPassParams params = CoarseCoverage();
  const Locator reach = *ReachLocator(locator, params, RunContext());
  ExpectStops([&](const RunContext& run) { return RestPaths(locator, reach, {}, params, run).status(); });
}

TEST(Cancel, Lines) {
  const Surface surface = SurfaceOf(BumpyPart());
  const ZeroField field = FieldOf(ContourInflectionLines(), 0.0);
  ExpectStops([&](const RunContext& run) {
    return TraceZeroCurves(surface, field, ZeroMeshParams(), 1e-3, run).status();
  });
}

TEST(Cancel, FlowLines) {
  const Surface surface = PlacedSurface(RandomPart(7, 8, 40.0));
  ExpectStops([&](const RunContext& run) { return TraceFlowLines(surface, {.spacing = 0.5}, run).status(); });
  ExpectStops([&](const RunContext& run) {
    return TraceFlowLines(surface, {.kind = FlowKind::kAlongCurvature, .spacing = 0.5}, run).status();
  });
}

}  // namespace
}  // namespace patchmill
