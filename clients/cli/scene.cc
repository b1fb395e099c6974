#include "clients/cli/scene.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <map>
#include <string_view>
#include <utility>

#include <absl/strings/escaping.h>
#include <absl/strings/str_replace.h>
#include <fmt/format.h>
#include <google/protobuf/io/gzip_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/struct.pb.h>

#include "clients/cli/scene_arrays.h"
#include "clients/cli/scene_bodies.h"
#include "clients/cli/scene_buffers.h"
#include "clients/cli/scene_words.h"
#include "clients/cli/text.h"
#include "clients/cli/viewer_page.h"

namespace patchmill::cli {
namespace {

using google::protobuf::ListValue;
using google::protobuf::Struct;
using google::protobuf::Value;

Value& In(Struct& object, const std::string& name) { return (*object.mutable_fields())[name]; }
void Set(Struct& object, const std::string& name, const std::string& text) {
  In(object, name).set_string_value(text);
}
void Set(Struct& object, const std::string& name, double number) {
  In(object, name).set_number_value(number);
}
void SetNull(Struct& object, const std::string& name) {
  In(object, name).set_null_value(google::protobuf::NULL_VALUE);
}
void Add(ListValue& list, std::initializer_list<double> numbers) {
  ListValue& item = *list.add_values()->mutable_list_value();
  for (const double number : numbers) item.add_values()->set_number_value(number);
}
ListValue& NewList(Struct& object, const std::string& name) {
  ListValue& list = *In(object, name).mutable_list_value();
  list.Clear();
  return list;
}
void SetPoint(Struct& object, const std::string& name, const v1::Point3& p) {
  ListValue& list = NewList(object, name);
  for (const double x : {p.x_mm(), p.y_mm(), p.z_mm()}) list.add_values()->set_number_value(x);
}

void AddRegions(const v1::RegionMap& map, Struct& header) {
  ListValue& list = NewList(header, "regions");
  for (const v1::Region& region : map.regions()) {
    Struct& item = *list.add_values()->mutable_struct_value();
    Set(item, "id", region.id());
    Set(item, "name", RegionName(region));
    Set(item, "color", RegionColor(region));
    Set(item, "unreachable", IsUnreached(region) ? Short(region.unreachable_reason()) : "");
  }
}

void AddBorders(const v1::RegionMap& map, Struct& header, SceneBuffers& buffers) {
  std::map<v1::BorderKind, double> lengths;
  for (const v1::BorderLine& line : map.border_lines()) lengths[line.kind()] += LengthOf(line);
  ListValue& list = NewList(header, "borders");
  std::vector<float> positions;
  for (const v1::BorderLine& line : map.border_lines()) {
    const auto& points = line.points_mm();
    if (points.size() < 6) continue;
    Struct& item = *list.add_values()->mutable_struct_value();
    Set(item, "name", fmt::format("{}: {:.1f} mm", BorderName(line.kind()), lengths[line.kind()]));
    Set(item, "color", BorderColor(line.kind()));
    Set(item, "first", static_cast<double>(positions.size() / 3));
    positions.insert(positions.end(), points.begin(), points.end());
    if (line.closed()) positions.insert(positions.end(), points.begin(), points.begin() + 3);
    Set(item, "count", static_cast<double>(points.size() / 3 + (line.closed() ? 1 : 0)));
  }
  buffers.Add("border.position", positions);
}

void AddMesh(const std::vector<v1::MeshBlock>& mesh, Struct& header, SceneBuffers& buffers) {
  std::vector<float> position, normal, slope, curvature, leftover, gouge;
  std::vector<std::uint32_t> index, surface;
  std::vector<std::int32_t> region;
  ListValue& names = NewList(header, "surfaces");
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  std::uint32_t patches = 0;
  for (const v1::MeshBlock& block : mesh) {
    const auto first = static_cast<std::uint32_t>(slope.size());
    append(position, block.position_mm());
    append(normal, block.normal());
    append(slope, block.slope_deg());
    // The page counts outward bends as positive.
    for (const float c : block.contour_curvature_per_mm()) curvature.push_back(-c);
    append(leftover, block.leftover_mm());
    append(gouge, block.gouge_mm());
    for (const std::int32_t corner : block.corners())
      index.push_back(first + static_cast<std::uint32_t>(corner));
    append(region, block.region_id());
    for (const std::int32_t patch : block.patch_index()) {
      surface.push_back(static_cast<std::uint32_t>(patch));
      patches = std::max(patches, surface.back() + 1);
    }
    for (const std::string& name : block.patch_names()) {
      names.add_values()->set_string_value(name.empty() ? fmt::format("patch {}", names.values_size() - 1)
                                                        : name);
    }
  }
  while (names.values_size() < static_cast<int>(patches))
    names.add_values()->set_string_value(fmt::format("patch {}", names.values_size() - 1));
  buffers.Add("mesh.position", position);
  buffers.Add("mesh.normal", normal);
  buffers.Add("mesh.slope", slope);
  buffers.Add("mesh.curvature", curvature);
  if (!leftover.empty()) buffers.Add("mesh.leftover", leftover);
  if (!gouge.empty()) buffers.Add("mesh.gouge", gouge);
  buffers.Add("mesh.index", index);
  buffers.Add("mesh.region", region);
  buffers.Add("mesh.surface", surface);
}

constexpr std::uint8_t kBetweenPasses = 255;

// A section begins where the region or the kind of the passes changes.
class Sections {
 public:
  explicit Sections(ListValue& list) : list_(list) {}
  void Next(std::size_t move, std::uint8_t kind, std::int32_t region) {
    if (kind == kBetweenPasses || std::pair(kind, region) == last_) return;
    last_ = {kind, region};
    Struct& item = *list_.add_values()->mutable_struct_value();
    Set(item, "name",
        region < 0 ? fmt::format("{} passes", kPassNames[kind])
                   : fmt::format("region {}: {} passes", region, kPassNames[kind]));
    Set(item, "first_move", static_cast<double>(move));
  }

 private:
  ListValue& list_;
  std::pair<std::uint8_t, std::int32_t> last_{kBetweenPasses, -2};
};

void AddPaths(const std::vector<v1::PathBlock>& paths, Struct& header, SceneBuffers& buffers) {
  std::vector<float> tip, feed, seconds, arc_center, arc_turns;
  std::vector<std::uint8_t> kind, pass_kind, arc_plane;
  std::vector<std::int32_t> region, pass;
  std::vector<std::uint32_t> line, arc_move;
  Sections sections(NewList(header, "sections"));
  for (const v1::PathBlock& block : paths) {
    tip.insert(tip.end(), block.tip_mm().begin(), block.tip_mm().end());
    feed.insert(feed.end(), block.feed_mm_per_min().begin(), block.feed_mm_per_min().end());
    seconds.insert(seconds.end(), block.seconds().begin(), block.seconds().end());
    for (int i = 0; i < block.line_size(); ++i) {
      const auto move = kind.size();
      kind.push_back(static_cast<std::uint8_t>(block.kind(i)));
      const int passes = block.pass_kind_size() > 0 ? block.pass_kind(i) : 0;
      pass_kind.push_back(passes > 0 ? static_cast<std::uint8_t>(passes - 1) : kBetweenPasses);
      region.push_back(block.region_id_size() > 0 ? block.region_id(i) : -1);
      pass.push_back(block.pass_index_size() > 0 ? block.pass_index(i) : -1);
      line.push_back(static_cast<std::uint32_t>(block.line(i)));
      sections.Next(move, pass_kind.back(), region.back());
      if (block.arc_plane(i) == v1::ARC_PLANE_UNSPECIFIED) continue;
      arc_move.push_back(static_cast<std::uint32_t>(move));
      arc_plane.push_back(static_cast<std::uint8_t>(block.arc_plane(i)));
    }
    arc_center.insert(arc_center.end(), block.arc_center_mm().begin(), block.arc_center_mm().end());
    arc_turns.insert(arc_turns.end(), block.arc_turns().begin(), block.arc_turns().end());
  }
  ListValue& names = NewList(header, "passes");
  const bool known =
      std::any_of(pass_kind.begin(), pass_kind.end(), [](auto k) { return k != kBetweenPasses; });
  for (const char* name : kPassNames) {
    if (known) names.add_values()->set_string_value(name);
  }
  if (kind.empty()) return;
  buffers.Add("path.tip", tip);
  buffers.Add("path.kind", kind);
  buffers.Add("path.pass_kind", pass_kind);
  buffers.Add("path.region", region);
  buffers.Add("path.pass", pass);
  buffers.Add("path.feed", feed);
  buffers.Add("path.seconds", seconds);
  buffers.Add("path.line", line);
  if (arc_move.empty()) return;
  buffers.Add("arc.move", arc_move);
  buffers.Add("arc.plane", arc_plane);
  buffers.Add("arc.center", arc_center);
  buffers.Add("arc.turns", arc_turns);
}

void AddTool(const v1::Tool& tool, Struct& header) {
  Struct& item = *In(header, "tool").mutable_struct_value();
  const double diameter = tool.ball_end().diameter_mm();
  Set(item, "ball_diameter", diameter);
  if (tool.has_flute_length_mm()) {
    Set(item, "flute_length", tool.flute_length_mm());
  } else {
    SetNull(item, "flute_length");
  }
  Set(item, "shank_diameter", tool.has_shank_diameter_mm() ? tool.shank_diameter_mm() : diameter);
  if (tool.holder().empty()) {
    SetNull(item, "holder");
    return;
  }
  Struct& holder = *In(item, "holder").mutable_struct_value();
  Set(holder, "stickout", tool.stickout_mm());
  ListValue& profile = NewList(holder, "profile");
  double height = 0.0;
  for (const v1::HolderSegment& segment : tool.holder()) {
    Add(profile, {height, 0.5 * segment.lower_diameter_mm()});
    height += segment.length_mm();
    Add(profile, {height, 0.5 * segment.upper_diameter_mm()});
  }
}

void AddOutline(const Prism& prism, Struct& item) {
  ListValue& outline = NewList(item, "outline");
  for (const auto& [x, y] : prism.outline) Add(outline, {x, y});
}

void AddStock(const std::optional<Prism>& stock, Struct& header) {
  if (!stock) return SetNull(header, "stock");
  Struct& item = *In(header, "stock").mutable_struct_value();
  Set(item, "bottom", stock->bottom);
  Set(item, "top", stock->top);
  AddOutline(*stock, item);
}

void AddClamps(const std::vector<Prism>& clamps, Struct& header) {
  ListValue& list = NewList(header, "clamps");
  for (const Prism& clamp : clamps) {
    Struct& item = *list.add_values()->mutable_struct_value();
    Set(item, "name", clamp.name);
    AddOutline(clamp, item);
    Set(item, "top", clamp.top);
  }
}

void AddFigure(ListValue& list, const std::string& name, const std::string& value) {
  ListValue& item = *list.add_values()->mutable_list_value();
  item.add_values()->set_string_value(name);
  item.add_values()->set_string_value(value);
}

// The figures of the summary of `mill`, in its words.
void AddReport(const v1::Report& report, Struct& header) {
  Set(header, "outcome", report.outcome() == v1::OUTCOME_UNSPECIFIED ? "" : Short(report.outcome()));
  Set(header, "time_basis", report.time_basis());
  ListValue& figures = NewList(header, "figures");
  if (report.outcome() != v1::OUTCOME_UNSPECIFIED) {
    AddFigure(figures, "largest gouge", fmt::format("{:.4f} mm", report.max_gouge_mm()));
    AddFigure(figures, "largest leftover", fmt::format("{:.4f} mm", report.max_leftover_mm()));
    AddFigure(figures, "not reached", UncutShare(report));
    AddFigure(figures, "lowest tip", fmt::format("Z {:.4f}", report.tip_z_min_mm()));
    AddFigure(figures, "feed length", fmt::format("{:.2f} m", report.cut_length_mm() / 1000.0));
    AddFigure(figures, "rapid length", fmt::format("{:.2f} m", report.rapid_length_mm() / 1000.0));
    if (report.estimated_time_s() > 0.0)
      AddFigure(figures, "time",
                fmt::format("{:.1f} min ({})", report.estimated_time_s() / 60.0, report.time_basis()));
    AddFigure(figures, "retracts", fmt::format("{}", report.retract_count()));
    AddFigure(figures, "stick-out at least", fmt::format("{:.1f} mm", report.required_stickout_mm()));
    if (!report.setup_sheet().work_offset().empty())
      AddFigure(figures, "work offset", report.setup_sheet().work_offset());
  }
  ListValue& findings = NewList(header, "findings");
  for (const v1::Diagnostic& finding : report.diagnostics()) {
    Struct& item = *findings.add_values()->mutable_struct_value();
    const char* severity = finding.severity() == v1::SEVERITY_ERROR     ? "ERROR"
                           : finding.severity() == v1::SEVERITY_WARNING ? "WARNING"
                                                                        : "INFO";
    Set(item, "severity", severity);
    Set(item, "code", finding.code());
    Set(item, "message", finding.message());
    if (finding.where().has_point()) {
      SetPoint(item, "point", finding.where().point());
    } else {
      SetNull(item, "point");
    }
  }
}

// Browsers inflate data faster than they read it as text. The fastest level leaves 40 %, the best one 38 %.
std::string Gzip(const std::string& bytes) {
  std::string packed;
  google::protobuf::io::StringOutputStream stream(&packed);
  google::protobuf::io::GzipOutputStream::Options options;
  options.compression_level = 1;
  google::protobuf::io::GzipOutputStream gzip(&stream, options);
  for (std::size_t at = 0; at < bytes.size();) {
    void* room = nullptr;
    int size = 0;
    if (!gzip.Next(&room, &size)) return {};
    const std::size_t taken = std::min(bytes.size() - at, static_cast<std::size_t>(size));
    std::memcpy(room, bytes.data() + at, taken);
    gzip.BackUp(size - static_cast<int>(taken));
    at += taken;
  }
  return gzip.Close() ? packed : std::string();
}

}  // namespace

absl::Status CheckArrays(const Scene& scene) {
  absl::Status status = CheckMesh(scene.mesh);
  status.Update(CheckPaths(scene.paths));
  status.Update(CheckBorders(scene.regions));
  return status;
}

absl::Status CheckPage() {
  if (!ViewerPage().empty()) return absl::OkStatus();
  return absl::FailedPreconditionError(
      "this patchmill was built without the 3-D page; build it with Node.js (scripts/setup.sh), or choose a "
      "picture that ends in .svg");
}

absl::StatusOr<std::string> MakePage(const Scene& scene) {
  if (const absl::Status can = CheckPage(); !can.ok()) return can;
  if (scene.mesh.empty()) return absl::DataLossError("the answer has no triangles; no page was written");
  if (const absl::Status whole = CheckArrays(scene); !whole.ok()) return whole;
  Struct header;
  SceneBuffers buffers;
  Set(header, "version", 1.0);
  Set(header, "title", scene.title);
  Set(header, "made_by", "patchmill " PATCHMILL_VERSION);
  Set(header, "data_encoding", "gzip");
  Set(header, "tolerance", scene.tolerance);
  if (scene.scallop) {
    Set(header, "scallop", *scene.scallop);
  } else {
    SetNull(header, "scallop");
  }
  Set(header, "steep_angle", scene.steep_angle);
  const render::Box box = BoxOf(scene.mesh);
  Struct& corners = *In(header, "box").mutable_struct_value();
  for (const auto& [name, corner] : {std::pair("min", box.min), std::pair("max", box.max)}) {
    ListValue& list = NewList(corners, name);
    for (const double x : corner) list.add_values()->set_number_value(x);
  }
  AddTool(scene.tool, header);
  AddStock(StockOf(scene, box), header);
  AddClamps(ClampsOf(scene.setup, box.min[2]), header);
  AddReport(scene.report, header);
  AddRegions(scene.regions, header);
  AddBorders(scene.regions, header, buffers);
  AddMesh(scene.mesh, header, buffers);
  AddPaths(scene.paths, header, buffers);
  if (!scene.program.empty()) buffers.Add("program.text", scene.program);
  *In(header, "buffers").mutable_struct_value() = buffers.table();
  // No text of a client may end the script that holds the header.
  const std::string json = absl::StrReplaceAll(SortedJson(header), {{"<", "\\u003c"}});
  if (json.empty()) return absl::InternalError("the scene of the 3-D page has a text that is not UTF-8");
  constexpr std::string_view kScene = "@PATCHMILL_SCENE@", kData = "@PATCHMILL_DATA@";
  const std::string_view page = ViewerPage();
  const std::size_t scene_at = page.find(kScene), data_at = page.find(kData);
  if (scene_at == page.npos || data_at == page.npos || data_at < scene_at)
    return absl::InternalError("the 3-D page has no place for the scene");
  std::string html(page.substr(0, scene_at));
  html += json;
  html += page.substr(scene_at + kScene.size(), data_at - scene_at - kScene.size());
  html += absl::Base64Escape(Gzip(buffers.bytes()));
  html += page.substr(data_at + kData.size());
  return html;
}

}  // namespace patchmill::cli
