#include "clients/cli/scene_arrays.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>

namespace patchmill::cli {
namespace {

// Pages hold numbers of 32 bits.
constexpr double kMost = std::numeric_limits<float>::max();
// Servers take 100,000 patches at most.
constexpr int kMostPatches = 1 << 20;
// One turn written as a rounded number may be a little more than 1.
constexpr double kMostTurns = 1.0001;

struct Range {
  double least = -kMost, most = kMost;
};

absl::Status Damaged(const std::string& what) {
  return absl::DataLossError(fmt::format("the answer of the server is damaged: {}", what));
}

absl::Status CheckCount(const char* name, int count, int wanted) {
  if (count == wanted) return absl::OkStatus();
  return Damaged(fmt::format("{} has {} numbers; must have {}", name, count, wanted));
}

// Arrays that the server may leave out.
absl::Status CheckCountOrNone(const char* name, int count, int wanted) {
  return count == 0 ? absl::OkStatus() : CheckCount(name, count, wanted);
}

template <class Array>
absl::Status CheckNumbers(const char* name, const Array& numbers, Range range = {}) {
  for (int i = 0; i < numbers.size(); ++i) {
    const auto number = static_cast<double>(numbers.Get(i));
    if (number >= range.least && number <= range.most) continue;
    const std::string must = range.most == kMost && range.least == -kMost ? "finite"
                             : range.most == kMost ? fmt::format("at least {:g}", range.least)
                                                   : fmt::format("{:g} to {:g}", range.least, range.most);
    return Damaged(fmt::format("{}[{}] = {:g}; must be {}", name, i, number, must));
  }
  return absl::OkStatus();
}

absl::Status CheckBlock(const v1::MeshBlock& block, int patches) {
  const int vertices = block.position_mm_size() / 3, triangles = block.corners_size() / 3;
  absl::Status status = CheckCount("mesh.position_mm", block.position_mm_size(), 3 * vertices);
  status.Update(CheckCount("mesh.normal", block.normal_size(), 3 * vertices));
  status.Update(CheckCount("mesh.slope_deg", block.slope_deg_size(), vertices));
  status.Update(CheckCount("mesh.contour_curvature_per_mm", block.contour_curvature_per_mm_size(), vertices));
  status.Update(CheckCountOrNone("mesh.leftover_mm", block.leftover_mm_size(), vertices));
  status.Update(CheckCountOrNone("mesh.gouge_mm", block.gouge_mm_size(), vertices));
  status.Update(CheckCount("mesh.corners", block.corners_size(), 3 * triangles));
  status.Update(CheckCount("mesh.patch_index", block.patch_index_size(), triangles));
  status.Update(CheckCount("mesh.region_id", block.region_id_size(), triangles));
  status.Update(CheckNumbers("mesh.position_mm", block.position_mm()));
  status.Update(CheckNumbers("mesh.normal", block.normal()));
  status.Update(CheckNumbers("mesh.slope_deg", block.slope_deg(), {0.0, 180.001}));
  status.Update(CheckNumbers("mesh.contour_curvature_per_mm", block.contour_curvature_per_mm()));
  status.Update(CheckNumbers("mesh.leftover_mm", block.leftover_mm()));
  status.Update(CheckNumbers("mesh.gouge_mm", block.gouge_mm()));
  status.Update(CheckNumbers("mesh.corners", block.corners(), {0.0, vertices - 1.0}));
  status.Update(CheckNumbers("mesh.patch_index", block.patch_index(), {0.0, patches - 1.0}));
  status.Update(CheckNumbers("mesh.region_id", block.region_id(), {-1.0, kMost}));
  return status;
}

absl::Status CheckBlock(const v1::PathBlock& block) {
  const int moves = block.kind_size();
  const auto arcs =
      static_cast<int>(moves - std::count(block.arc_plane().begin(), block.arc_plane().end(), 0));
  absl::Status status = CheckCount("path.tip_mm", block.tip_mm_size(), 3 * moves);
  status.Update(CheckCountOrNone("path.pass_kind", block.pass_kind_size(), moves));
  status.Update(CheckCountOrNone("path.region_id", block.region_id_size(), moves));
  status.Update(CheckCountOrNone("path.pass_index", block.pass_index_size(), moves));
  status.Update(CheckCount("path.feed_mm_per_min", block.feed_mm_per_min_size(), moves));
  status.Update(CheckCount("path.seconds", block.seconds_size(), moves));
  status.Update(CheckCount("path.line", block.line_size(), moves));
  status.Update(CheckCount("path.arc_plane", block.arc_plane_size(), moves));
  status.Update(CheckCount("path.arc_center_mm", block.arc_center_mm_size(), 3 * arcs));
  status.Update(CheckCount("path.arc_turns", block.arc_turns_size(), arcs));
  status.Update(CheckNumbers("path.tip_mm", block.tip_mm()));
  status.Update(CheckNumbers("path.kind", block.kind(), {v1::MOVE_KIND_RAPID, v1::MoveKind_MAX}));
  status.Update(
      CheckNumbers("path.pass_kind", block.pass_kind(), {v1::PASS_KIND_UNSPECIFIED, v1::PASS_KIND_REST}));
  status.Update(CheckNumbers("path.region_id", block.region_id(), {-1.0, kMost}));
  status.Update(CheckNumbers("path.pass_index", block.pass_index(), {-1.0, kMost}));
  status.Update(CheckNumbers("path.feed_mm_per_min", block.feed_mm_per_min(), {0.0, kMost}));
  status.Update(CheckNumbers("path.seconds", block.seconds(), {0.0, kMost}));
  status.Update(CheckNumbers("path.line", block.line(), {0.0, kMost}));
  status.Update(CheckNumbers("path.arc_plane", block.arc_plane(), {0.0, v1::ArcPlane_MAX}));
  status.Update(CheckNumbers("path.arc_center_mm", block.arc_center_mm()));
  status.Update(CheckNumbers("path.arc_turns", block.arc_turns(), {-kMostTurns, kMostTurns}));
  return status;
}

}  // namespace

absl::Status CheckMesh(const std::vector<v1::MeshBlock>& mesh) {
  int patches = 0, leftover = 0, gouge = 0, blocks = 0;
  for (const v1::MeshBlock& block : mesh) patches += block.patch_names_size();
  if (patches == 0) patches = kMostPatches;
  absl::Status status;
  for (const v1::MeshBlock& block : mesh) {
    status.Update(CheckBlock(block, patches));
    if (block.position_mm().empty()) continue;
    ++blocks;
    leftover += block.leftover_mm().empty() ? 0 : 1;
    gouge += block.gouge_mm().empty() ? 0 : 1;
  }
  // A page shows leftover and gouge of all vertices or of none.
  const auto all_or_none = [&](const char* name, int with) {
    if (with > 0 && with < blocks)
      status.Update(Damaged(fmt::format("{} of {} blocks have {}; all or none must", with, blocks, name)));
  };
  all_or_none("mesh.leftover_mm", leftover);
  all_or_none("mesh.gouge_mm", gouge);
  return status;
}

absl::Status CheckPaths(const std::vector<v1::PathBlock>& paths) {
  absl::Status status;
  for (const v1::PathBlock& block : paths) status.Update(CheckBlock(block));
  const bool begins_with_arc =
      !paths.empty() && !paths.front().arc_plane().empty() && paths.front().arc_plane(0) != 0;
  if (begins_with_arc)
    status.Update(Damaged("path.arc_plane[0] is that of an arc, which needs a move before it"));
  return status;
}

absl::Status CheckBorders(const v1::RegionMap& map) {
  absl::Status status;
  for (const v1::BorderLine& line : map.border_lines()) {
    status.Update(
        CheckCount("regions.border_lines.points_mm", line.points_mm_size(), line.points_mm_size() / 3 * 3));
    status.Update(CheckNumbers("regions.border_lines.points_mm", line.points_mm()));
  }
  return status;
}

}  // namespace patchmill::cli
