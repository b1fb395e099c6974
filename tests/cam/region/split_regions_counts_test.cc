// How many regions a machinist is shown: tests/cam/region/split_regions_counts.txt, and no other number when
// the shape moves by what nobody can see. Networks: tests/service/regions_test.cc.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include "cam/region/split_regions.h"
#include "core/base/error_details.h"
#include "core/network/control_points.h"
#include "tests/support/fuzz.h"
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

// A file without a row is a row's model once more, or none that can be read.
TEST(RegionCounts, EveryModelAtHandHasARow) {
  namespace fs = std::filesystem;
  std::set<std::string> named;
  for (const testing::TableRow& row : testing::ModelTable()) named.insert(row.file);
  const auto ending = [](const fs::path& path) { return path.extension().string().substr(1); };
  int without = 0;
  const auto look = [&](const fs::path& directory, const std::string& as) {
    if (!fs::exists(directory)) return;
    for (const auto& entry : fs::directory_iterator(directory)) {
      const std::string name = entry.path().filename().string();
      if (!entry.is_regular_file() || entry.path().extension().empty() || named.count(as + name) > 0)
        continue;
      if (as == "examples/" && (name.ends_with(".md") || name.ends_with(".txt"))) continue;
      ++without;
      SCOPED_TRACE(as + name);
      const auto model = ReadModelText(ending(entry.path()), *testing::ReadFile(entry.path()));
      if (!model.ok()) {
        EXPECT_TRUE(ending(entry.path()) == "dat" || ending(entry.path()) == "obj" ||
                    CodeOf(model.status()) == "ZERO_WEIGHT")
            << model.status();
        continue;
      }
      const PatchModel teapot = testing::LoadModel("examples/teapot.bpt");
      ASSERT_EQ(model->patches.size(), teapot.patches.size());
      for (std::size_t k = 0; k < teapot.patches.size(); ++k)
        EXPECT_TRUE(std::ranges::equal(ControlPoints(model->patches[k].shape),
                                       ControlPoints(teapot.patches[k].shape)));
    }
  };
  look(PATCHMILL_SOURCE_DIR "/examples", "examples/");
  EXPECT_EQ(without, 0);
  look(PATCHMILL_SOURCE_DIR "/../shared/data/patches", "shared/data/patches/");
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
      if (seed > 7 && !testing::LongTests()) break;
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
