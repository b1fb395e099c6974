#include "clients/cli/part_tables.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "clients/cli/text.h"

namespace patchmill::cli {
namespace {

constexpr std::size_t kFacesShown = 6;
constexpr std::size_t kRadiiShown = 4;  // of each kind of faces
constexpr std::size_t kHolesShown = 12;

// "f1 f2 and 7 more".
std::string FaceList(const std::vector<std::string>& ids, bool all) {
  const std::size_t shown = all ? ids.size() : std::min(ids.size(), kFacesShown);
  std::string text;
  for (std::size_t k = 0; k < shown; ++k) text += (k > 0 ? " " : "") + Printable(ids[k]);
  if (shown < ids.size()) text += fmt::format(" and {} more", ids.size() - shown);
  return text;
}

// "-Z" for an axis, else its components.
std::string DirectionText(const google::protobuf::RepeatedField<double>& direction) {
  if (direction.size() != 3) return "?";
  constexpr double kAlong = 1.0 - 1e-9;
  for (int k = 0; k < 3; ++k) {
    if (std::abs(direction[k]) > kAlong) return fmt::format("{}{}", direction[k] < 0 ? "-" : "+", "XYZ"[k]);
  }
  // Adding zero turns -0 into 0.
  const auto rounded = [&](int k) { return std::round(direction[k] * 1000.0) / 1000.0 + 0.0; };
  return fmt::format("({:g}, {:g}, {:g})", rounded(0), rounded(1), rounded(2));
}

// "diameter 6.6, depth 10, through, along -Z".
std::string HoleText(const v1::Hole& hole) {
  const auto end_text = [](v1::HoleEnd end) -> std::string_view {
    switch (end) {
      case v1::HOLE_END_FLOOR:
        return "a floor";
      case v1::HOLE_END_STEP:
        return "a step";
      default:
        return "open";
    }
  };
  const bool open = hole.first_end() == v1::HOLE_END_OPEN;
  std::string form;
  if (open && hole.second_end() == v1::HOLE_END_OPEN) {
    form = "open at both ends";
  } else if (open) {
    form = fmt::format("down to {}", end_text(hole.second_end()));
  } else {
    form = fmt::format("closed by {} and {}", end_text(hole.first_end()), end_text(hole.second_end()));
  }
  return fmt::format("diameter {:.6g}, depth {:.5g}, {}, along {}", hole.diameter_mm(), hole.depth_mm(), form,
                     DirectionText(hole.direction()));
}

}  // namespace

void PrintConcaveFaces(const v1::CheckModelResponse& response, bool all) {
  const std::size_t count = static_cast<std::size_t>(response.concave_faces_size());
  if (count == 0) return;
  fmt::print("concave faces, and the largest ball that their curvature lets in:\n");
  std::size_t of_kind = 0, left_out = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const v1::ConcaveFaces& group = response.concave_faces(static_cast<int>(k));
    const bool first = k == 0 || response.concave_faces(static_cast<int>(k) - 1).kind() != group.kind();
    of_kind = first ? 1 : of_kind + 1;
    if (!all && of_kind > kRadiiShown) {
      ++left_out;
      continue;
    }
    const std::vector<std::string> ids(group.face_ids().begin(), group.face_ids().end());
    fmt::print("  {:<8} R {:<8.5g} ball D {:<8.5g} {:>4} face{} {:>10.5g} mm2  {}\n", Short(group.kind()),
               group.min_radius_mm(), group.max_tool_diameter_mm(), ids.size(), ids.size() == 1 ? " " : "s",
               group.area_mm2(), FaceList(ids, all));
  }
  if (left_out > 0) fmt::print("  and {} larger radii (--all-findings)\n", left_out);
}

void PrintHoles(const v1::CheckModelResponse& response, bool all) {
  struct Kind {
    std::string text;
    int count = 0;
    std::vector<std::string> faces;
  };
  std::vector<Kind> kinds;
  for (const v1::Hole& hole : response.holes()) {
    const std::string text = HoleText(hole);
    auto kind = std::find_if(kinds.begin(), kinds.end(), [&](const Kind& k) { return k.text == text; });
    if (kind == kinds.end()) kind = kinds.insert(kinds.end(), {text, 0, {}});
    ++kind->count;
    kind->faces.insert(kind->faces.end(), hole.face_ids().begin(), hole.face_ids().end());
  }
  if (kinds.empty()) return;
  fmt::print("holes        {}\n", response.holes_size());
  const std::size_t shown = all ? kinds.size() : std::min(kinds.size(), kHolesShown);
  for (std::size_t k = 0; k < shown; ++k)
    fmt::print("  {} x {}: {}\n", kinds[k].count, kinds[k].text, FaceList(kinds[k].faces, all));
  if (shown < kinds.size()) fmt::print("  and {} more lines (--all-findings)\n", kinds.size() - shown);
}

void PrintUpDirections(const v1::CheckModelResponse& response) {
  for (const v1::UpDirection& direction : response.up_directions()) {
    fmt::print("--up {:<7} {:>10.1f} mm2 look up, {:.1f} of them are hidden; {} level face{}{}\n",
               Short(direction.up()), direction.facing_area_mm2(), direction.hidden_area_mm2(),
               direction.level_face_count(), direction.level_face_count() == 1 ? "" : "s",
               direction.up() == response.best_up() ? "; shows most" : "");
  }
}

}  // namespace patchmill::cli
