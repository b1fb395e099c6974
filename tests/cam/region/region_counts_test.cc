// How many regions a machinist is shown: tests/cam/region/region_counts.txt, and no other number when the
// shape moves by what nobody can see. Networks: tests/service/regions_test.cc.
#include <cmath>
#include <iostream>
#include <map>
#include <tuple>

#include <gtest/gtest.h>

#include "cam/region/region_map.h"
#include "core/network/control_points.h"
#include "tests/support/model_table.h"
#include "tests/support/random.h"
#include "tests/support/sanitized.h"

namespace patchmill {
namespace {

// Equal points stay equal, so that patches stay joined.
void Shake(double by, std::uint64_t seed, PatchModel& model) {
  testing::Random random(seed);
  std::map<std::tuple<long, long, long>, Vec3> moves;
  for (Patch& patch : model.patches) {
    for (Vec3& p : ControlPoints(patch.shape)) {
      const auto key =
          std::make_tuple(std::lround(p.x() * 1e3), std::lround(p.y() * 1e3), std::lround(p.z() * 1e3));
      const auto [move, fresh] = moves.try_emplace(key, Vec3::Zero());
      if (fresh) move->second = random.Point(-by, by);
      p += move->second;
    }
  }
}

Surface Build(const PatchModel& model) {
  PatchNetwork network;
  network.model = model;
  network.join_tolerance = 2e-3;
  auto surface = BuildSurface(std::move(network), SurfaceParams(), RunContext());
  EXPECT_TRUE(surface.ok()) << surface.status();
  return *std::move(surface);
}

RegionMap Split(const Surface& surface, const RegionParams& params = {}) {
  auto map = SplitRegions(surface, params, RunContext());
  EXPECT_TRUE(map.ok()) << map.status();
  return *std::move(map);
}

int CountOf(const PatchModel& model) {
  int count = 0;
  for (const Region& r : Split(Build(model)).regions) count += r.kind != RegionKind::kUnreachable;
  return count;
}

TEST(RegionCounts, AreThoseOfTheTableWithAndWithoutNoise) {
  const std::vector<testing::TableRow> table = testing::ModelTable();
  ASSERT_GE(table.size(), 13u);
  for (const testing::TableRow& row : table) {
    SCOPED_TRACE(row.file + ": " + row.why);
    auto found = testing::ModelOf(row);
    if (!found) {
      if (testing::IsNetwork(row)) continue;  // service/regions_test.cc counts them
      std::cerr << row.file << " is not here: not tested\n";
      continue;
    }
    EXPECT_GE(row.count, 1);
    EXPECT_LE(row.count, 20);
    EXPECT_EQ(CountOf(*found), row.count);
    for (const std::uint64_t seed : {7, 8, 9}) {
      if (testing::kSanitized && seed > 7) break;
      PatchModel model = *found;
      Shake(0.005, seed, model);
      EXPECT_LE(std::abs(CountOf(model) - row.count), 2) << "with noise " << seed;
    }
  }
}

// However it lies, the regions are the whole surface. On its side curvature has no value at the poles.
TEST(RegionCounts, TheTeapotHasOneAreaHoweverItLies) {
  const PatchModel teapot = testing::LoadModel("examples/teapot.bpt");
  double upright = 0.0;
  for (const UpAxis up : {UpAxis::kY, UpAxis::kZ, UpAxis::kX, UpAxis::kNegY}) {
    const Surface surface = Build(Place(Placement{.scale = 54.8, .up = up}, teapot));
    RegionParams params;
    params.floor_z = surface.box.min.z();
    double area = 0.0;
    for (const Region& r : Split(surface, params).regions) area += r.area;
    if (up == UpAxis::kY) upright = area;
    EXPECT_NEAR(area, upright, 1e-4 * upright);
  }
  EXPECT_GT(upright, 0.0);
}

}  // namespace
}  // namespace patchmill
