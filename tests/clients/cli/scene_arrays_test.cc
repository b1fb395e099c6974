// Answers that no server of Patchmill sends: each broken array is named, and a whole answer passes.
#include "clients/cli/scene_arrays.h"

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patchmill::cli {
namespace {

using ::testing::HasSubstr;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

template <class Array, class... Numbers>
void Fill(Array* array, Numbers... numbers) {
  (array->Add(numbers), ...);
}

// A square of two triangles on one patch.
v1::MeshBlock Square() {
  v1::MeshBlock block;
  Fill(block.mutable_position_mm(), 0.F, 0.F, 0.F, 9.F, 0.F, 0.F, 9.F, 9.F, 0.F, 0.F, 9.F, 0.F);
  for (int vertex = 0; vertex < 4; ++vertex) {
    Fill(block.mutable_normal(), 0.F, 0.F, 1.F);
    block.add_slope_deg(0.F);
    block.add_contour_curvature_per_mm(0.F);
    block.add_leftover_mm(0.01F);
    block.add_gouge_mm(0.F);
  }
  Fill(block.mutable_corners(), 0, 1, 2, 0, 2, 3);
  Fill(block.mutable_patch_index(), 0, 0);
  Fill(block.mutable_region_id(), -1, 0);
  block.add_patch_names("lid");
  return block;
}

// Down onto a pass, along a line and along a half circle.
v1::PathBlock HalfCircle() {
  v1::PathBlock block;
  Fill(block.mutable_tip_mm(), 0.0, 0.0, 5.0, 0.0, 0.0, 0.0, 4.0, 0.0, 0.0, 8.0, 0.0, 0.0);
  for (const auto kind : {v1::MOVE_KIND_RAPID, v1::MOVE_KIND_PLUNGE, v1::MOVE_KIND_CUT, v1::MOVE_KIND_CUT}) {
    block.add_kind(kind);
    block.add_pass_kind(kind == v1::MOVE_KIND_CUT ? v1::PASS_KIND_CONTOUR : v1::PASS_KIND_UNSPECIFIED);
    block.add_region_id(kind == v1::MOVE_KIND_CUT ? 0 : -1);
    block.add_pass_index(kind == v1::MOVE_KIND_CUT ? 0 : -1);
    block.add_feed_mm_per_min(kind == v1::MOVE_KIND_RAPID ? 0.F : 900.F);
    block.add_seconds(0.5F);
    block.add_line(block.line_size());
    block.add_arc_plane(block.line_size() == 4 ? v1::ARC_PLANE_XY : v1::ARC_PLANE_UNSPECIFIED);
  }
  Fill(block.mutable_arc_center_mm(), 6.0, 0.0, 0.0);
  block.add_arc_turns(-0.5);
  return block;
}

std::string MeshFault(const std::function<void(v1::MeshBlock&)>& damage) {
  v1::MeshBlock block = Square();
  damage(block);
  const absl::Status status = CheckMesh({Square(), block});
  EXPECT_TRUE(status.ok() || status.code() == absl::StatusCode::kDataLoss) << status;
  return std::string(status.message());
}

std::string PathFault(const std::function<void(v1::PathBlock&)>& damage) {
  v1::PathBlock block = HalfCircle();
  damage(block);
  const absl::Status status = CheckPaths({HalfCircle(), block});
  EXPECT_TRUE(status.ok() || status.code() == absl::StatusCode::kDataLoss) << status;
  return std::string(status.message());
}

TEST(SceneArrays, AWholeAnswerPasses) {
  EXPECT_TRUE(CheckMesh({}).ok());
  EXPECT_TRUE(CheckPaths({}).ok());
  EXPECT_EQ(MeshFault([](v1::MeshBlock&) {}), "");
  EXPECT_EQ(PathFault([](v1::PathBlock&) {}), "");
  // Without a verified program, and from VerifyProgram.
  v1::MeshBlock bare = Square();
  bare.clear_leftover_mm();
  bare.clear_gouge_mm();
  EXPECT_TRUE(CheckMesh({bare, bare}).ok());
  EXPECT_EQ(PathFault([](v1::PathBlock& b) {
              b.clear_pass_kind();
              b.clear_region_id();
              b.clear_pass_index();
            }),
            "");
}

TEST(SceneArrays, ABrokenMeshIsNamed) {
  EXPECT_THAT(MeshFault([](auto& b) { b.add_position_mm(1.F); }), HasSubstr("mesh.position_mm has 13"));
  EXPECT_THAT(MeshFault([](auto& b) { b.add_normal(1.F); }),
              HasSubstr("mesh.normal has 13 numbers; must have 12"));
  EXPECT_THAT(MeshFault([](auto& b) { b.clear_slope_deg(); }), HasSubstr("mesh.slope_deg has 0"));
  EXPECT_THAT(MeshFault([](auto& b) { b.add_contour_curvature_per_mm(0.F); }),
              HasSubstr("contour_curvature"));
  EXPECT_THAT(MeshFault([](auto& b) { b.add_leftover_mm(0.F); }), HasSubstr("mesh.leftover_mm has 5"));
  EXPECT_THAT(MeshFault([](auto& b) { b.clear_leftover_mm(); }),
              HasSubstr("1 of 2 blocks have mesh.leftover_mm"));
  EXPECT_THAT(MeshFault([](auto& b) { b.clear_gouge_mm(); }), HasSubstr("1 of 2 blocks have mesh.gouge_mm"));
  EXPECT_THAT(MeshFault([](auto& b) { b.add_corners(0); }), HasSubstr("mesh.corners has 7"));
  EXPECT_THAT(MeshFault([](auto& b) { b.add_region_id(0); }), HasSubstr("mesh.region_id has 3"));
  EXPECT_THAT(MeshFault([](auto& b) { b.clear_patch_index(); }), HasSubstr("mesh.patch_index has 0"));
  EXPECT_THAT(MeshFault([](auto& b) { b.set_corners(4, 4); }),
              HasSubstr("mesh.corners[4] = 4; must be 0 to 3"));
  EXPECT_THAT(MeshFault([](auto& b) { b.set_corners(0, -1); }), HasSubstr("mesh.corners[0] = -1"));
  EXPECT_THAT(MeshFault([](auto& b) { b.set_patch_index(1, 2); }),
              HasSubstr("mesh.patch_index[1] = 2; must be 0 to 1"));
  EXPECT_THAT(MeshFault([](auto& b) { b.set_region_id(1, -2); }), HasSubstr("mesh.region_id[1] = -2"));
  EXPECT_THAT(MeshFault([](auto& b) { b.set_position_mm(5, kNan); }),
              HasSubstr("mesh.position_mm[5] = nan; must be finite"));
  EXPECT_THAT(MeshFault([](auto& b) { b.set_normal(2, kInfinity); }), HasSubstr("mesh.normal[2] = inf"));
  EXPECT_THAT(MeshFault([](auto& b) { b.set_slope_deg(2, 181.F); }), HasSubstr("mesh.slope_deg[2] = 181"));
  EXPECT_THAT(MeshFault([](auto& b) { b.set_leftover_mm(3, kNan); }), HasSubstr("mesh.leftover_mm[3] = nan"));
  EXPECT_THAT(MeshFault([](auto& b) { b.set_gouge_mm(3, -kInfinity); }),
              HasSubstr("mesh.gouge_mm[3] = -inf"));
}

// Whoever sends no names cannot make the page list two billion of them.
TEST(SceneArrays, PatchesWithoutNamesAreBounded) {
  v1::MeshBlock block = Square();
  block.clear_patch_names();
  EXPECT_TRUE(CheckMesh({block}).ok());
  block.set_patch_index(0, std::numeric_limits<std::int32_t>::max());
  EXPECT_THAT(std::string(CheckMesh({block}).message()), HasSubstr("mesh.patch_index[0]"));
}

TEST(SceneArrays, ABrokenPathIsNamed) {
  EXPECT_THAT(PathFault([](auto& b) { b.add_tip_mm(1.0); }),
              HasSubstr("path.tip_mm has 13 numbers; must have 12"));
  EXPECT_THAT(PathFault([](auto& b) { b.add_kind(v1::MOVE_KIND_CUT); }),
              HasSubstr("path.tip_mm has 12 numbers; must have 15"));
  EXPECT_THAT(PathFault([](auto& b) { b.add_pass_index(0); }), HasSubstr("path.pass_index has 5"));
  EXPECT_THAT(PathFault([](auto& b) { b.add_line(9); }), HasSubstr("path.line has 5"));
  EXPECT_THAT(PathFault([](auto& b) { b.clear_seconds(); }), HasSubstr("path.seconds has 0"));
  EXPECT_THAT(PathFault([](auto& b) { b.clear_arc_turns(); }),
              HasSubstr("path.arc_turns has 0 numbers; must have 1"));
  EXPECT_THAT(PathFault([](auto& b) { b.clear_arc_plane(); }), HasSubstr("path.arc_plane has 0"));
  EXPECT_THAT(PathFault([](auto& b) { b.set_arc_plane(1, v1::ARC_PLANE_XY); }),
              HasSubstr("path.arc_center_mm has 3"));
  EXPECT_THAT(PathFault([](auto& b) { b.set_kind(1, v1::MOVE_KIND_UNSPECIFIED); }),
              HasSubstr("path.kind[1] = 0"));
  EXPECT_THAT(PathFault([](auto& b) { b.set_kind(1, static_cast<v1::MoveKind>(99)); }),
              HasSubstr("path.kind[1] = 99"));
  EXPECT_THAT(PathFault([](auto& b) { b.set_pass_kind(2, static_cast<v1::PassKind>(250)); }),
              HasSubstr("path.pass_kind[2] = 250"));
  EXPECT_THAT(PathFault([](auto& b) { b.set_arc_plane(3, static_cast<v1::ArcPlane>(7)); }),
              HasSubstr("path.arc_plane[3] = 7"));
  EXPECT_THAT(PathFault([](auto& b) { b.set_tip_mm(4, kNan); }),
              HasSubstr("path.tip_mm[4] = nan; must be finite"));
  EXPECT_THAT(PathFault([](auto& b) { b.set_arc_turns(0, 5.0); }), HasSubstr("path.arc_turns[0] = 5"));
  EXPECT_THAT(PathFault([](auto& b) { b.set_arc_center_mm(1, kInfinity); }),
              HasSubstr("path.arc_center_mm[1] = inf"));
  EXPECT_THAT(PathFault([](auto& b) { b.set_seconds(0, -1.F); }),
              HasSubstr("path.seconds[0] = -1; must be at least 0"));
}

TEST(SceneArrays, AnArcNeedsAMoveBeforeIt) {
  v1::PathBlock block = HalfCircle();
  block.set_arc_plane(3, v1::ARC_PLANE_UNSPECIFIED);
  block.set_arc_plane(0, v1::ARC_PLANE_XY);
  EXPECT_THAT(std::string(CheckPaths({block}).message()), HasSubstr("path.arc_plane[0]"));
  EXPECT_TRUE(CheckPaths({HalfCircle(), block}).ok()) << "a move of the block before";
}

TEST(SceneArrays, ABrokenBorderIsNamed) {
  v1::RegionMap map;
  auto& points = *map.add_border_lines()->mutable_points_mm();
  Fill(&points, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0);
  EXPECT_TRUE(CheckBorders(map).ok());
  points.Add(1.0);
  EXPECT_THAT(std::string(CheckBorders(map).message()), HasSubstr("points_mm has 7 numbers; must have 6"));
  points.RemoveLast();
  points.Set(1, 1e300);
  EXPECT_THAT(std::string(CheckBorders(map).message()), HasSubstr("points_mm[1] = 1e+300; must be finite"));
}

}  // namespace
}  // namespace patchmill::cli
