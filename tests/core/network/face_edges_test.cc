// Models whose patches are parts of faces: what is found about their edges, and faults of faces.
#include "core/network/face_edges.h"

#include <algorithm>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/faced_box.h"

namespace patchmill {
namespace {

using ::testing::ElementsAre;
using testing::FacedBox;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

PatchNetwork Build(PatchModel model) {
  auto network = BuildNetwork(std::move(model));
  EXPECT_TRUE(network.ok()) << network.status();
  return network.ok() ? *std::move(network) : PatchNetwork();
}

std::vector<std::string> Messages(const PatchNetwork& network, std::string_view code) {
  std::vector<std::string> messages;
  for (const Diagnostic& d : network.findings) {
    if (d.code == code) messages.push_back(d.message);
  }
  return messages;
}

TEST(FaceEdges, ABoxHasTwelve) {
  for (const int cuts : {1, 2, 5}) {
    SCOPED_TRACE(cuts);
    const PatchNetwork network = Build(FacedBox(10.0, cuts));
    EXPECT_EQ(network.findings.size(), 12u);
    EXPECT_EQ(network.open_edge_count, 0);
    EXPECT_EQ(network.euler_characteristic, 2);
    EXPECT_NEAR(network.convex_length, 120.0, 1e-9);
    EXPECT_EQ(network.concave_length, 0.0);
    const auto breaks = Messages(network, "TANGENT_BREAK");
    ASSERT_EQ(breaks.size(), 12u);
    EXPECT_EQ(breaks.front(), "face f1 meets face f3 (wall) at an angle of up to 90 degrees, along 10 mm");
    for (const Diagnostic& finding : network.findings) {
      EXPECT_EQ(finding.where.face_id.substr(0, 1), "f");
      EXPECT_THAT(finding.where.patch_id, HasSubstr(finding.where.face_id + "."));
    }
  }
}

// The same faces turned over: a hollow, seen from inside.
TEST(FaceEdges, InnerCorners) {
  PatchModel model = FacedBox(10.0, 2);
  for (Patch& patch : model.patches) {
    auto& points = std::get<BezierPatch>(patch.shape).points;
    std::swap(points[1], points[2]);
  }
  const PatchNetwork network = Build(std::move(model));
  EXPECT_NEAR(network.concave_length, 120.0, 1e-9);
  EXPECT_EQ(network.convex_length, 0.0);
  EXPECT_EQ(
      Messages(network, "TANGENT_BREAK").front(),
      "face f1 meets face f3 (wall) at an angle of up to 90 degrees, along 10 mm, of which 10 mm are an "
      "inner corner");
}

TEST(FaceEdges, AnOpenFaceIsOneFinding) {
  PatchModel model = FacedBox(10.0, 3);
  std::erase_if(model.patches, [](const Patch& patch) { return patch.face == FaceId(1); });
  const PatchNetwork network = Build(std::move(model));
  EXPECT_EQ(network.open_edge_count, 12);
  const auto open = Messages(network, "OPEN_EDGE");
  ASSERT_EQ(open.size(), 4u);
  EXPECT_EQ(open.front(), "face f3 (wall) has no neighbour along 3 edges, 10 mm in all");
}

// One patch less per side on the top face: its edges meet two edges of the sides each.
TEST(FaceEdges, NothingIsSaidOfTJunctions) {
  PatchModel model = FacedBox(10.0, 2);
  PatchModel coarse = FacedBox(10.0, 1);
  std::erase_if(model.patches, [](const Patch& patch) { return patch.face == FaceId(1); });
  const auto lid = std::find_if(coarse.patches.begin(), coarse.patches.end(),
                                [](const Patch& patch) { return patch.face == FaceId(1); });
  model.patches.push_back(*lid);
  const PatchNetwork network = Build(std::move(model));
  EXPECT_EQ(network.part_links.size(), 8u);
  EXPECT_THAT(Messages(network, "T_JUNCTION"), IsEmpty());
  EXPECT_THAT(Messages(network, "OPEN_EDGE"), IsEmpty());
  EXPECT_EQ(network.t_junction_count, 0);
  const auto breaks = Messages(network, "TANGENT_BREAK");
  EXPECT_EQ(breaks.size(), 12u);
  EXPECT_THAT(breaks, ::testing::Contains(
                          "face f2 (lid) meets face f3 (wall) at an angle of up to 90 degrees, along 10 mm"));
  EXPECT_NEAR(network.convex_length, 120.0, 1e-9);
}

// The sides are of no face: what is said of their edges is said as without faces.
TEST(FaceEdges, TJunctionsWithPatchesOfNoFaceAreFound) {
  PatchModel model = FacedBox(10.0, 2);
  PatchModel coarse = FacedBox(10.0, 1);
  std::erase_if(model.patches, [](const Patch& patch) { return patch.face == FaceId(1); });
  for (Patch& patch : model.patches) patch.face.reset();
  model.patches.push_back(coarse.patches[1]);
  EXPECT_EQ(Messages(Build(std::move(model)), "T_JUNCTION").size(), 4u);
}

// The same patches without faces: findings about each edge.
TEST(FaceEdges, WithoutFacesEachEdgeOfAPatchCounts) {
  PatchModel model = FacedBox(10.0, 2);
  model.faces.clear();
  for (Patch& patch : model.patches) patch.face.reset();
  const PatchNetwork network = Build(std::move(model));
  EXPECT_EQ(Messages(network, "TANGENT_BREAK").size(), 24u);
}

// A patch of no face beside faces keeps findings of its own.
TEST(FaceEdges, APatchOfNoFaceBesideFaces) {
  PatchModel model = FacedBox(10.0, 1);
  model.patches[1].face.reset();
  const PatchNetwork network = Build(std::move(model));
  EXPECT_EQ(Messages(network, "TANGENT_BREAK").size(), 12u);
  const auto breaks = Messages(network, "TANGENT_BREAK");
  EXPECT_EQ(std::count_if(breaks.begin(), breaks.end(),
                          [](const std::string& text) { return text.find("patch 1 (f2.1)") != text.npos; }),
            4);
}

// The face has a fin: three of its patches share an edge. One finding says so, whatever their number.
TEST(FaceEdges, AFaceThatIsFoldedIsOneFinding) {
  PatchModel model;
  model.faces.emplace_back().id = "f1";
  const auto add = [&](const Vec3& o, const Vec3& u, const Vec3& v) {
    model.patches.push_back({"", testing::Bilinear(o, o + u, o + v, o + u + v), FaceId(std::size_t{0})});
  };
  for (const double y : {0.0, 10.0}) {
    add({0, y, 0}, {10, 0, 0}, {0, 10, 0});
    add({10, y, 0}, {10, 0, 0}, {0, 10, 0});
    add({10, y, 0}, {0, 0, 10}, {0, 10, 0});
  }
  EXPECT_THAT(
      Messages(Build(std::move(model)), "NON_MANIFOLD_EDGE"),
      ElementsAre("face f1 is folded, or has needles narrower than the join tolerance: 2 edges inside it "
                  "are shared by more than two of its patches"));
}

TEST(FaceFaults, AreAllFound) {
  PatchModel model = FacedBox(10.0, 1);
  model.faces[2].id = "f1";
  model.faces[3].id = "";
  model.faces[4].radius = -1.0;
  model.patches[5].face = FaceId(std::int32_t{6});
  model.patches[4].face = FaceId(std::int32_t{-1});
  std::vector<std::string> messages;
  for (const Diagnostic& fault : ValidateModel(model)) messages.push_back(fault.message);
  EXPECT_THAT(messages,
              ElementsAre("faces[2].id = \"f1\" is also the id of faces[0]; must be unique",
                          "faces[3].id is missing", "faces[4].radius_mm = -1; must be finite and at least 0",
                          "patches[4].face_index = -1; the model has 6 faces",
                          "patches[5].face_index = 6; the model has 6 faces"));
}

TEST(FacePlacement, RadiiAreScaled) {
  PatchModel model = FacedBox(10.0, 1);
  model.faces[0].radius = 3.0;
  EXPECT_EQ(Place({.scale = 25.4}, model).faces[0].radius, 3.0 * 25.4);
}

}  // namespace
}  // namespace patchmill
