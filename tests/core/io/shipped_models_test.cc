// The models in examples/ and tests/models are what their READMEs say. PATCHMILL_UPDATE_GOLDEN=1 writes those
// that are computed anew.
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>

#include <absl/strings/str_cat.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/bv.h"
#include "core/network/control_points.h"
#include "core/network/patch_network.h"
#include "tests/support/bezier_form.h"
#include "tests/support/files.h"
#include "tests/support/shapes.h"

namespace patchmill {
namespace {

using testing::LoadModel;

// The file holds `model` to `digits` significant digits.
void ExpectFileHolds(const std::string& path, const PatchModel& model, int digits) {
  if (std::getenv("PATCHMILL_UPDATE_GOLDEN") != nullptr) {
    std::ofstream(PATCHMILL_SOURCE_DIR "/" + path, std::ios::binary) << *WriteBv(model, digits);
  }
  const PatchModel file = LoadModel(path);
  ASSERT_EQ(file.patches.size(), model.patches.size());
  const double tolerance = std::pow(10.0, -digits) * ControlBox(model).Diagonal();
  for (std::size_t k = 0; k < file.patches.size(); ++k) {
    const auto want = ControlPoints(model.patches[k].shape), have = ControlPoints(file.patches[k].shape);
    ASSERT_EQ(have.size(), want.size());
    for (std::size_t i = 0; i < have.size(); ++i) EXPECT_LE((have[i] - want[i]).norm(), tolerance);
  }
}

TEST(Examples, TwoHillsInterpolatesItsFunction) {
  ExpectFileHolds("examples/two_hills.bv", testing::BezierForm(testing::TwoHills()), 10);
  const PatchModel hills = LoadModel("examples/two_hills.bv");
  ASSERT_EQ(hills.patches.size(), 1024u);
  for (const Patch& patch : hills.patches) {
    for (const double u : {0.0, 1.0}) {
      for (const double v : {0.0, 1.0}) {
        const Vec3 p = Position(patch.shape, u, v);
        EXPECT_NEAR(p.z(), testing::TwoHillsHeight(p.x(), p.y()), 3e-8);
      }
    }
  }
}

TEST(Examples, TwoHillsIsOneSmoothSheet) {
  const auto hills = BuildNetwork(LoadModel("examples/two_hills.bv"));
  ASSERT_TRUE(hills.ok()) << hills.status();
  EXPECT_EQ(hills->open_edge_count, 4 * 32);
  EXPECT_EQ(hills->component_count, 1);
  EXPECT_EQ(hills->boundary_loop_count, 1);
  EXPECT_EQ(hills->euler_characteristic, 1);
  for (const EdgeLink& link : hills->edges) {
    EXPECT_LE(link.gap, 1e-9);
    EXPECT_LE(link.max_angle, 1e-7);  // ten digits of the file over a span of 3 mm
  }
}

TEST(Models, SphereIsExact) {
  ExpectFileHolds("tests/models/sphere.bv", testing::Sphere({0, 0, 0}, 1), 17);
  for (const Patch& patch : LoadModel("tests/models/sphere.bv").patches) {
    for (double u = 0; u <= 1; u += 0.125) {
      for (double v = 0; v <= 1; v += 0.125) EXPECT_NEAR(Position(patch.shape, u, v).norm(), 1.0, 1e-15);
    }
  }
}

// What BuildNetwork must say about each awkward model, and no other code (TANGENT_BREAK and OPEN_EDGE with
// counts).
struct Awkward {
  const char* file;
  std::map<std::string, int> codes;
};
const Awkward kAwkward[] = {
    {"bicubic.bez", {{"OPEN_EDGE", 4}}},
    {"closed_edge.bpt", {{"OPEN_EDGE", 2}, {"TANGENT_BREAK", 1}}},
    {"collapsed_edge.bpt", {{"COLLAPSED_EDGE", 1}, {"OPEN_EDGE", 3}}},
    {"crlf_and_bom.bpt", {{"OPEN_EDGE", 4}}},
    {"cusp.bpt", {{"OPEN_EDGE", 4}}},
    {"degree15.bpt", {{"OPEN_EDGE", 4}}},
    {"degree1_15.bpt", {{"OPEN_EDGE", 4}}},
    {"double_control_points.bpt", {{"OPEN_EDGE", 4}}},
    {"duplicate_patch.bpt", {{"DUPLICATE_PATCH", 1}, {"NON_MANIFOLD_EDGE", 1}, {"OPEN_EDGE", 6}}},
    {"far_from_origin.bpt", {{"OPEN_EDGE", 4}}},
    {"folded_back.bpt", {{"OPEN_EDGE", 6}, {"TANGENT_BREAK", 1}}},
    {"gap.bpt", {{"GAP", 1}, {"OPEN_EDGE", 8}}},
    {"gregory_collapsed_edge.patches", {{"COLLAPSED_EDGE", 1}, {"OPEN_EDGE", 3}}},
    {"gregory_crease.patches", {{"OPEN_EDGE", 6}, {"TANGENT_BREAK", 1}}},
    {"gregory_twisted_corner.patches", {{"OPEN_EDGE", 4}}},
    {"huge_scale.bpt", {{"OPEN_EDGE", 4}}},
    {"icosahedron.patches", {}},
    {"knife_edge_peak.bpt", {{"OPEN_EDGE", 4}}},
    {"loop.bpt", {{"OPEN_EDGE", 4}}},
    {"mixed_kinds.bv", {{"OPEN_EDGE", 9}}},
    {"moebius.bpt",
     {{"INCONSISTENT_ORIENTATION", 1},
      {"OPEN_EDGE", 16},
      {"TANGENT_BREAK", 7}}},  // the seam is smooth by symmetry
    {"mushroom.bpt", {{"OPEN_EDGE", 8}}},
    {"nearly_collapsed_edge.bpt", {{"NEARLY_COLLAPSED_EDGE", 1}, {"OPEN_EDGE", 3}}},
    {"no_area.bpt", {{"COLLAPSED_EDGE", 2}}},
    {"non_manifold_edge.bpt", {{"NON_MANIFOLD_EDGE", 1}, {"OPEN_EDGE", 9}, {"TANGENT_BREAK", 1}}},
    {"non_manifold_vertex.bpt", {{"NON_MANIFOLD_VERTEX", 1}, {"OPEN_EDGE", 8}}},
    {"quarter_cylinder.bez", {{"OPEN_EDGE", 4}}},
    {"saddle.patches", {{"OPEN_EDGE", 12}}},
    {"sliver.bpt", {{"NEARLY_COLLAPSED_EDGE", 2}, {"OPEN_EDGE", 6}}},
    {"sphere.bv", {{"COLLAPSED_EDGE", 8}}},
    {"t_junction.bpt", {{"OPEN_EDGE", 7}, {"T_JUNCTION", 1}}},
    {"tangent_break.bpt", {{"OPEN_EDGE", 6}, {"TANGENT_BREAK", 1}}},
    {"teacup.bpt", {{"NON_MANIFOLD_VERTEX", 1}, {"OPEN_EDGE", 12}, {"TANGENT_BREAK", 4}}},
    {"tiny_scale.bpt", {{"OPEN_EDGE", 4}}},
    {"toroidal_tet.patches", {}},
    {"torus_bicubic.patches", {}},
    {"triangle_degree1.bv", {{"OPEN_EDGE", 3}}},
    {"triangle_degree15.bv", {{"OPEN_EDGE", 3}}},
    {"triangle_fan.bv", {{"OPEN_EDGE", 48}}},
    {"uneven_weights.bv", {{"OPEN_EDGE", 4}}},
    {"vertical_only.bpt", {{"OPEN_EDGE", 4}}},
    {"vertical_wall.bpt", {{"OPEN_EDGE", 8}, {"TANGENT_BREAK", 2}}},
};

std::map<std::string, int> FindingCodes(PatchModel model, const char* file) {
  const auto network = BuildNetwork(std::move(model));
  EXPECT_TRUE(network.ok()) << file << ": " << network.status();
  std::map<std::string, int> codes;
  if (!network.ok()) return codes;
  for (const Diagnostic& d : network->findings) ++codes[d.code];
  return codes;
}

TEST(Models, AwkwardOnesHaveTheFindingsTheyWereMadeFor) {
  for (const Awkward& awkward : kAwkward) {
    const PatchModel model = LoadModel(std::string("tests/models/") + awkward.file);
    EXPECT_EQ(FindingCodes(model, awkward.file), awkward.codes) << awkward.file;
  }
}

TEST(Models, FindingsDoNotDependOnPlaceTurnOrSize) {
  Eigen::Affine3d motion = Eigen::Affine3d::Identity();
  motion.translate(Vec3(30, -50, 20)).rotate(Eigen::AngleAxisd(1.1, Vec3(1, 2, 3).normalized())).scale(7.3);
  for (const Awkward& awkward : kAwkward) {
    // Too small beside the move: rounding would be larger than its join tolerance.
    if (std::string_view(awkward.file) == "tiny_scale.bpt") continue;
    const PatchModel model = LoadModel(std::string("tests/models/") + awkward.file);
    EXPECT_EQ(FindingCodes(testing::Transformed(model, motion), awkward.file), awkward.codes) << awkward.file;
  }
}

TEST(Models, CatalogueAndReadmeNameEveryFile) {
  std::set<std::string> tested;
  for (const Awkward& awkward : kAwkward) tested.insert(awkward.file);
  const std::string readme = testing::ReadRepositoryFile("tests/models/README.md");
  const std::filesystem::path folder = PATCHMILL_SOURCE_DIR "/tests/models";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (!entry.is_regular_file() || name == "README.md") continue;
    if (name.ends_with(".bpt") || name.ends_with(".bv") || name.ends_with(".bez") ||
        name.ends_with(".patches")) {
      EXPECT_EQ(tested.count(name), 1u) << name;
    }
    EXPECT_THAT(readme, ::testing::HasSubstr(absl::StrCat("`", name, "`")));
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder / "malformed")) {
    EXPECT_THAT(readme, ::testing::HasSubstr(absl::StrCat("`", entry.path().filename().string(), "`")));
  }
}

}  // namespace
}  // namespace patchmill
