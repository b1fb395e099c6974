// The unreachable area according to the regions of the planner, its table of radii and the report of the
// verifier, against a count by brute force: within 1 %.
#include <numeric>

#include <gtest/gtest.h>

#include "cam/limits/reach_tolerance.h"
#include "cam/region/figures/reach_table.h"
#include "cam/region/split_regions.h"
#include "cam/verify/leftover.h"
#include "tests/support/fuzz.h"
#include "tests/support/model_table.h"
#include "tests/support/reach_oracle.h"
#include "tests/support/shapes.h"
#include "tests/support/surface_of.h"

namespace patchmill {
namespace {

using namespace testing;  // NOLINT: the support folder's

constexpr int kPlaces = 12'000;

double OfRegions(const Surface& surface, const ReachQuestion& question) {
  RegionParams params;
  params.radius = question.radius;
  params.tolerance = question.tolerance;
  params.floor_z = question.floor_z;
  const auto map = SplitRegions(surface, params, RunContext());
  EXPECT_TRUE(map.ok()) << map.status();
  double sum = 0.0;
  for (const Region& r : map->regions) sum += r.kind == RegionKind::kUnreachable ? r.area : 0.0;
  return sum;
}

double OfTable(const Surface& surface, const ReachQuestion& question) {
  ReachTableParams params;
  params.radii = {question.radius};
  params.tolerance = question.tolerance;
  params.floor_z = question.floor_z;
  const auto table = ReachTable(surface, params, RunContext());
  EXPECT_TRUE(table.ok()) << table.status();
  return table->unreachable[0];
}

// As Verify measures it, of a program without moves.
double OfReport(const Surface& surface, const ReachQuestion& question) {
  LeftoverParams params;
  params.reach = {question.radius, ReachTolerance(question.tolerance), question.floor_z + question.radius};
  params.most = surface.box.Diagonal();
  const RunContext run;
  const std::vector<CellRect> roots = RootCells(surface, 0.3 * question.radius, run);
  const auto areas =
      MeasureAreas({surface, roots}, SegmentTree({}, Metric::kPath, question.radius, run), params, run);
  EXPECT_TRUE(areas.ok()) << areas.status();
  double sum = 0.0;
  for (const FinishClass c : {FinishClass::kUndercut, FinishClass::kConcave, FinishClass::kFloor})
    sum += areas->area[c];
  return sum;
}

// All three within 1 % of what was counted, and what the count itself may be off.
void ExpectCounted(const PatchModel& model, const ReachQuestion& question, std::uint64_t seed) {
  Random random(seed);
  const ReachCount count = CountUnreachable(model, question, kPlaces, random);
  const Surface surface = SurfaceOf(model);
  const double slack = 0.01 * count.unreachable + 4.0 * count.deviation;
  EXPECT_LT(count.deviation, 0.004 * count.area);
  EXPECT_NEAR(OfRegions(surface, question), count.unreachable, slack) << "of " << count.area;
  EXPECT_NEAR(OfTable(surface, question), count.unreachable, slack) << "of " << count.area;
  EXPECT_NEAR(OfReport(surface, question), count.unreachable, slack) << "of " << count.area;
}

TEST(UnreachableArea, OfRealParts) {
  const std::vector<TableRow> table = ModelTable();
  for (std::size_t k = 0; k < table.size(); ++k) {
    const TableRow& row = table[k];
    if (k % 3 != 0 && !LongTests()) continue;
    SCOPED_TRACE(row.file);
    if (const auto model = ModelOf(row)) ExpectCounted(*model, {}, 1);
  }
}

TEST(UnreachableArea, OfRealPartsOnTheFloorTheyStandOn) {
  for (const TableRow& row : ModelTable()) {
    if (row.file != "examples/teapot.bpt" && row.file != "examples/two_hills.bv") continue;
    SCOPED_TRACE(row.file);
    const PatchModel model = *ModelOf(row);
    ExpectCounted(model, {.floor_z = SurfaceOf(model).box.min.z()}, 2);
  }
}

TEST(UnreachableArea, OfRandomSplines) {
  for (std::uint64_t seed = 11; seed < static_cast<std::uint64_t>(11 + CountOf(3, 6)); ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    RandomBsplineParams part;
    part.size = random.Uniform(12.0, 25.0);
    part.amplitude = random.Uniform(2.0, 6.0);
    part.folds = seed % 3 == 0;
    part.rational = seed % 2 == 0;
    ExpectCounted(RandomBspline(seed, part), {.radius = random.Uniform(1.0, 4.0), .tolerance = 0.02}, seed);
  }
}

}  // namespace
}  // namespace patchmill
