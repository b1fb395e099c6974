#include <cmath>
#include <filesystem>
#include <map>
#include <memory>

#include <fmt/format.h>

#include "clients/cli/call.h"
#include "clients/cli/commands.h"
#include "clients/cli/job_options.h"
#include "clients/cli/limit_options.h"
#include "clients/cli/output_file.h"
#include "clients/cli/picture_options.h"
#include "clients/cli/region_options.h"
#include "clients/cli/scene.h"
#include "clients/cli/text.h"
#include "patchmill/v1/analysis_service.grpc.pb.h"

namespace patchmill::cli {
namespace {

constexpr double kWhole = 1e-6;  // share of the area; less than this is rounding
constexpr double kFew = 0.005;   // share of the area; a smaller share cut in another way is not printed

struct RegionsOptions {
  CommonOptions common;
  SetupOptions setup;
  ReadingOptions reading;
  OperationOptions operation;
  LimitOptions limits;
  RegionChangeOptions regions;
  std::string model, output;
  PictureFlags picture;
};

bool IsIn3d(const OutputFile& output) { return output.EndsIn(".html") || output.EndsIn(".png"); }

absl::StatusOr<v1::SplitRegionsRequest> MakeRequest(const RegionsOptions& options, const OutputFile& output) {
  v1::SplitRegionsRequest request;
  absl::StatusOr<v1::ModelSource> source = ReadModel(options.model, options.reading);
  if (!source.ok()) return source.status();
  absl::StatusOr<v1::Setup> setup = MakeSetup(options.setup, options.reading.length_unit);
  if (!setup.ok()) return setup.status();
  v1::Job& job = *request.mutable_job();
  *job.mutable_source() = *std::move(source);
  *job.mutable_setup() = *std::move(setup);
  v1::Operation& operation = *job.add_operations();
  absl::StatusOr<v1::Operation> made = MakeOperation(options.operation);
  if (!made.ok()) return made.status();
  operation = *std::move(made);
  v1::Selection selection;
  if (const absl::Status set = SetLimits(options.limits, *job.mutable_setup(), selection); !set.ok())
    return set;
  if (Selects(options.limits)) *operation.mutable_selection() = std::move(selection);
  if (options.limits.top) operation.mutable_heights()->set_top_z_mm(*options.limits.top);
  const absl::Status regions =
      SetRegions(options.regions, operation.mutable_regions_sha256(), operation.mutable_region_overrides());
  if (!regions.ok()) return regions;
  job.set_name(WireText(std::filesystem::path(options.model).filename().string(), 100));
  request.add_outputs(v1::OUTPUT_REGIONS);
  if (output.EndsIn(".svg")) request.add_outputs(v1::OUTPUT_PICTURE);
  if (IsIn3d(output)) request.add_outputs(v1::OUTPUT_TESSELLATION);
  request.set_max_threads(options.common.threads);
  return request;
}

std::string HowItIsCut(const v1::Region& region) {
  if (region.skipped()) return "off";
  if (region.area_mm2() > 0.0 && !(region.selected_area_mm2() > 0.0)) return "not selected";
  std::string text;
  if (region.kind() == v1::REGION_KIND_UNREACHABLE) {
    text = fmt::format("{}, up to {:.3f} mm stays", Short(region.unreachable_reason()),
                       region.deepest_leftover_mm());
    if (region.largest_tool_diameter_mm() > 0.0)
      text += fmt::format(", reached by D {:.2f}", region.largest_tool_diameter_mm());
    return text;
  }
  if (region.unreachable_reason() == v1::UNREACHABLE_REASON_STRATEGY)
    text = fmt::format("not finished (STRATEGY), up to {:.3f} mm stays: ", region.deepest_leftover_mm());
  text += Short(region.strategy());
  const bool lines = region.strategy() == v1::STRATEGY_ZIGZAG;
  std::string around, otherwise;
  if (region.has_lines_around()) {
    const auto micron = [](double mm) { return std::round(1e3 * mm) / 1e3 + 0.0; };  // no -0.000
    around = fmt::format(" around {:.3f},{:.3f}", micron(region.lines_around().x_mm()),
                         micron(region.lines_around().y_mm()));
    if (region.more_lines_around_size() > 0)
      around += fmt::format(" and {} more centres", region.more_lines_around_size());
    if (region.has_zigzag_angle_deg()) around += ", others";
  }
  if (region.cut_otherwise_area_mm2() > kFew * region.area_mm2())
    otherwise = fmt::format(" on {:.1f} mm2 of it", region.cut_otherwise_area_mm2());
  if (!lines && !(around + otherwise).empty()) text += ", lines";
  text += around;
  if (region.has_zigzag_angle_deg())
    text += fmt::format(" {:g} deg{}", region.zigzag_angle_deg(), region.one_way_lines() ? " one way" : "");
  if (!otherwise.empty()) text += (lines ? ", contours" : "") + otherwise;
  text += fmt::format(", scallop {:g}, step {:.3f} to {:.3f} mm", region.scallop_mm(), region.step_min_mm(),
                      region.step_max_mm());
  if (region.selected_area_mm2() < (1.0 - kWhole) * region.area_mm2())
    text += fmt::format(", {:.1f} mm2 of it selected", region.selected_area_mm2());
  return text;
}

// "; on f1, f3 and 5 more"; empty if the model has no faces.
std::string FacesOf(const v1::Region& region) {
  constexpr int kMostListed = 4;
  std::string text;
  const int listed = region.face_ids_size() > kMostListed + 1 ? kMostListed : region.face_ids_size();
  for (int k = 0; k < listed; ++k) text += (k == 0 ? "; on " : ", ") + Printable(region.face_ids(k));
  if (listed < region.face_ids_size()) text += fmt::format(" and {} more", region.face_ids_size() - listed);
  return text;
}

void PrintBorders(const v1::RegionMap& map) {
  std::map<v1::BorderKind, double> lengths;
  for (const v1::BorderLine& line : map.border_lines()) lengths[line.kind()] += LengthOf(line);
  std::string text;
  for (const auto& [kind, length] : lengths) text += fmt::format("{} {:.1f} mm, ", Short(kind), length);
  fmt::print("borders: {}{} nodes\n", text, map.nodes_size());
}

void Print(const v1::RegionMap& map) {
  std::string digest;
  for (const char c : map.regions_sha256()) digest += fmt::format("{:02x}", static_cast<unsigned char>(c));
  fmt::print("regions sha256 {}\n", digest);
  fmt::print("{:>4} {:<18} {:>12}  {:<27} {}\n", "id", "region", "area, mm2", "a point of it", "cut by");
  for (const v1::Region& region : map.regions()) {
    std::string name = Short(region.kind());
    if (region.slope() != v1::SLOPE_UNSPECIFIED) name += ", " + Short(region.slope());
    const v1::Point3& p = region.inside_point();
    fmt::print("{:>4} {:<18} {:>12.3f}  {:<27} {}{}\n", region.id(), name, region.area_mm2(),
               fmt::format("{:.3f},{:.3f},{:.3f}", p.x_mm(), p.y_mm(), p.z_mm()), HowItIsCut(region),
               FacesOf(region));
  }
  PrintBorders(map);
}

// The part and its regions in 3-D.
Scene MakeScene(const RegionsOptions& options, const v1::SplitRegionsRequest& request,
                const v1::SplitRegionsResponse& response) {
  Scene scene;
  scene.title = request.job().name();
  scene.setup = request.job().setup();
  scene.tool = request.job().operations(0).tool();
  scene.tolerance = options.operation.tolerance;
  scene.scallop = options.operation.scallop;
  scene.steep_angle = options.operation.steep_angle;
  scene.regions = response.regions();
  scene.mesh = {response.mesh().begin(), response.mesh().end()};
  *scene.report.mutable_diagnostics() = response.diagnostics();
  return scene;
}

absl::Status Run(const RegionsOptions& options, InterruptWatch& watch) {
  OutputFile output(options.output, {".json", ".svg", ".png", ".html"});
  const absl::StatusOr<PictureOptions> picture = MakePictureOptions(options.picture);
  if (!picture.ok()) return picture.status();
  if (output.EndsIn(".html")) {
    if (const absl::Status can = CheckPage(); !can.ok()) return can;
  }
  absl::StatusOr<v1::SplitRegionsRequest> request = MakeRequest(options, output);
  if (!request.ok()) return request.status();
  if (const absl::Status writable = CheckWritable({&output}); !writable.ok()) return writable;
  absl::StatusOr<v1::SplitRegionsResponse> response =
      Call(options.common, watch, &v1::AnalysisService::Stub::SplitRegions, *request);
  if (!response.ok()) return response.status();
  if (IsIn3d(output)) {
    absl::StatusOr<std::string> made = MakePreview(MakeScene(options, *request, *response), output, *picture);
    if (!made.ok()) return made.status();
    output.Set(*std::move(made));
  } else if (output.wanted()) {
    output.Set(response->has_picture() ? response->picture().data() : Json(*response));
  }
  if (const absl::Status written = Commit({&output}); !written.ok()) return written;
  // Findings about the model are the business of `patchmill check`.
  for (const v1::Diagnostic& finding : response->diagnostics()) {
    if (finding.severity() != v1::SEVERITY_INFO && !finding.where().field().empty())
      fmt::print(stderr, "{}\n", Line(finding));
  }
  if (!output.is_standard() && (!options.common.quiet || !output.wanted())) Print(response->regions());
  return absl::OkStatus();
}

}  // namespace

Command AddRegions(CLI::App& app) {
  auto options = std::make_shared<RegionsOptions>();
  app.add_option("MODEL", options->model, kModelHelp)->required();
  app.add_option("-o,--output", options->output, "the region map: .json, .svg, or in 3-D .png or .html");
  AddPictureOptions(app, PictureOf::kRegions, options->picture);
  AddSplitOptions(app, options->operation);
  AddShankOptions(app, options->operation.shank);
  app.add_option("--strategy", options->operation.strategy,
                 "contours on steep and zig-zag lines on gentle areas (auto), or one of them everywhere")
      ->check(CLI::IsMember({"auto", "contour", "zigzag"}))
      ->capture_default_str();
  AddNumber(app, "--zigzag-angle", options->operation.zigzag_angle,
            "direction of zig-zag lines from +X, counter-clockwise, degrees");
  app.add_flag("--no-round-lines", options->operation.no_round_lines,
               "straight lines on rims and shoulders, too, where circular lines would be a tenth shorter");
  AddRegionChangeOptions(app, options->regions);
  AddLimitOptions(app, options->limits);
  AddReadingOptions(app, options->reading);
  AddSetupOptions(app, options->setup);
  AddCommonOptions(app, options->common);
  return [options](InterruptWatch& watch) { return Run(*options, watch); };
}

}  // namespace patchmill::cli
