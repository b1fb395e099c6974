#include "clients/cli/option_names.h"

namespace patchmill::cli {
namespace {

struct Entry {
  const char* field;
  const char* option;
};

// Options for every field below one of these paths.
constexpr Entry kLists[] = {
    {"region_overrides[", "--region"},
    {"setup.obstacles[", "--obstacle"},
    {"setup.machine.", "--machine"},
    {"locks[", "--lock"},
    {"edits[", "--edits, --push or --move"},
    {"uv[", "--at"},
    {"patch_index[", "--at"},
    {"wall_sides[", "--wall-side"},
    {"holder[", "--holder"},
    {"tools[", "--tool or --tool-diameter"},
    {"tool_diameters_mm[", "--tool-diameters"},
};

// Options for the fields whose path ends in one of these.
constexpr Entry kOptions[] = {
    {"ball_end.diameter_mm", "--tool-diameter"},
    {"flute_length_mm", "--flute-length"},
    {"shank_diameter_mm", "--shank-diameter"},
    {"stickout_mm", "--stickout"},
    {"tool.holder", "--holder"},
    {"holder_clearance_mm", "--holder-clearance"},
    {"scallop_mm", "--scallop"},
    {"tolerance_mm", "--tolerance"},
    {"stock_to_leave_mm", "--leave"},
    {"steep_angle_deg", "--steep-angle"},
    {"zigzag_angle_deg", "--zigzag-angle"},
    {"zigzag_angle_auto", "--auto-angle"},
    {"zigzag_bend_deg", "--bend"},
    {"operations[0].detail", "--detail"},
    {"regions_sha256", "--regions"},
    {"setup.up", "--up"},
    {"up_face", "--up"},
    {"cap_holes_mm", "--cap-holes"},
    {"skip_faces", "--skip-face"},
    {"border_tolerance_mm", "--border-tolerance"},
    {"source.file.length_unit", "--length-unit"},
    {"scale", "--scale"},
    {"setup.translation.x_mm", "--translate"},
    {"setup.translation.y_mm", "--translate"},
    {"setup.translation.z_mm", "--translate"},
    {"setup.program_zero.x_mm", "--zero"},
    {"setup.program_zero.y_mm", "--zero"},
    {"setup.program_zero.z_mm", "--zero"},
    {"floor_z_mm", "--floor"},
    {"heights.top_z_mm", "--top"},
    {"spacing_mm", "--spacing"},
    {"patch_ids", "--only"},
    {"avoid_patch_ids", "--avoid"},
    {"avoid_margin_mm", "--avoid-margin"},
    {"boundary_offset_mm", "--boundary-offset"},
    {"boundary_xy_mm", "--boundary"},
    {"clearance_above_mm", "--clearance"},
    {"heights.high_rapids", "--high-rapids"},
    {"heights.approach_gap_mm", "--approach-gap"},
    {"accept_depth_mm", "--accept-depth"},
    {"max_unreached_fraction", "--max-unreached"},
    {"leads.radius_mm", "--lead-radius"},
    {"leads.sweep_deg", "--lead-sweep"},
    {"feeds.plunge_angle_deg", "--plunge-angle"},
    {"feeds.link_mm_per_min", "--link-feed"},
    {"feeds.keep_on_passes", "--keep-feed"},
    {"keep_feed_on_passes", "--keep-feed"},
    {"feeds.lead_mm_per_min", "--lead-feed"},
    {"feeds.corner_mm_per_min", "--corner-feed"},
    {"stock.top_z_mm", "--stock-top"},
    {"stock.allowance_mm", "--allowance"},
    {"stock.wall_allowance_mm", "--allowance-walls"},
    {"stock.floor_allowance_mm", "--allowance-floors"},
    {"stock.block.margin_mm", "--stock"},
    {"stock.cylinder.diameter_mm", "--stock"},
    {"stock.cylinder.center_xy_mm", "--stock"},
    {"stock.outline.outline_xy_mm", "--stock"},
    {"stock.model", "--stock"},
    {"plunge_feed_mm_per_min", "--plunge-feed"},
    {"feed_mm_per_min", "--feed"},
    {"spindle_rpm", "--spindle"},
    {"tool.number", "--tool-number"},
    {"post.work_offset", "--work-offset"},
    {"post.dialect", "--post"},
    {"post.post_file", "--post"},
    {"post.program_number", "--program-number"},
    {"post.restart_points", "--restart-points"},
    {"post.unit", "--inch"},
    {"post.line_number_step", "--line-numbers"},
    {"control_deviation_mm", "--control-deviation"},
    {"assume_exact_path", "--assume"},
    {"machine_z_safe_mm", "--machine-z-safe"},
    {"dialect", "--dialect"},
    {"post_file", "--dialect"},
    {"polyline_tolerance_mm", "--tolerance"},
    {"band.x_mm", "--band"},
    {"band.y_mm", "--band"},
    {"band.z_mm", "--band"},
    {"band.fraction", "--band"},
    {"max_iterations", "--iterations"},
    {"start_direction", "--start-direction"},
    {"end_direction", "--end-direction"},
    {"line_count", "--net"},
    {"one_way_lines", "--one-way"},
    {"round_lines", "--no-round-lines"},
    {"border_passes", "--no-border-passes"},
    {"contour_spirals", "--spirals"},
    {"contour_direction", "--direction"},
    {"eye", "--eye"},
    {"direction", "--direction"},
    {"across", "--across"},
    {"levels", "--levels"},
    {"min_loop_mm", "--min-loop"},
};

}  // namespace

const char* OptionOf(std::string_view text) {
  std::string_view path = text.substr(0, text.find(' '));
  for (const auto& entry : kLists) {
    if (path.find(entry.field) != std::string_view::npos) return entry.option;
  }
  if (path.ends_with(']')) path = path.substr(0, path.rfind('['));  // an element of a list
  for (const auto& entry : kOptions) {
    const std::string_view field = entry.field;
    if (path.size() >= field.size() && path.substr(path.size() - field.size()) == field &&
        (path.size() == field.size() || path[path.size() - field.size() - 1] == '.')) {
      return entry.option;
    }
  }
  return nullptr;
}

}  // namespace patchmill::cli
