#include <filesystem>
#include <iterator>
#include <map>
#include <memory>

#include <absl/strings/ascii.h>
#include <fmt/format.h>

#include "clients/cli/call.h"
#include "clients/cli/commands.h"
#include "clients/cli/job_options.h"
#include "clients/cli/output_file.h"
#include "clients/cli/text.h"
#include "patchmill/v1/analysis_service.grpc.pb.h"

namespace patchmill::cli {
namespace {

const std::map<std::string, v1::LineKind> kKinds = {
    {"contour", v1::LINE_KIND_CONTOUR},
    {"slope", v1::LINE_KIND_EQUI_SLOPE},
    {"brightness", v1::LINE_KIND_BRIGHTNESS},
    {"silhouette", v1::LINE_KIND_SILHOUETTE},
    {"eye", v1::LINE_KIND_EYE_SILHOUETTE},
    {"highlight", v1::LINE_KIND_HIGHLIGHT},
    {"inflection", v1::LINE_KIND_CONTOUR_INFLECTION},
    {"slope-extremum", v1::LINE_KIND_SLOPE_EXTREMUM},
    {"flow", v1::LINE_KIND_FLOW},
    {"slope-flow", v1::LINE_KIND_SLOPE_FLOW},
    {"intersection", v1::LINE_KIND_INTERSECTION},
    {"curvature", v1::LINE_KIND_CURVATURE},
};

struct LinesOptions {
  CommonOptions common;
  SetupOptions setup;
  ReadingOptions reading;
  std::string model, output;
  std::vector<std::string> kinds = {"contour"};
  std::vector<double> levels, direction, across, eye;
  std::optional<int> count;
  std::optional<double> spacing;
  double tolerance = 0.01, min_loop = 0.1;
  bool from_normals = false;
};

void SetPoint(const std::vector<double>& xyz, v1::Point3* point) {
  point->set_x_mm(xyz[0]);
  point->set_y_mm(xyz[1]);
  point->set_z_mm(xyz[2]);
}

absl::StatusOr<v1::TraceLinesRequest> MakeRequest(const LinesOptions& options, bool picture) {
  v1::TraceLinesRequest request;
  absl::StatusOr<v1::ModelSource> source = ReadModel(options.model, options.reading);
  if (!source.ok()) return source.status();
  absl::StatusOr<v1::Setup> setup = MakeSetup(options.setup);
  if (!setup.ok()) return setup.status();
  *request.mutable_source() = *std::move(source);
  *request.mutable_setup() = *std::move(setup);
  if (!options.levels.empty() && options.kinds.size() > 1) {
    return absl::InvalidArgumentError("--levels belong to one --kind; several kinds are set");
  }
  bool any_chooses = false;
  for (const std::string& kind : options.kinds) {
    v1::LineFamily& family = *request.add_families();
    family.set_kind(kKinds.at(kind));
    if (!options.direction.empty()) SetPoint(options.direction, family.mutable_direction());
    if (!options.across.empty()) SetPoint(options.across, family.mutable_across());
    if (!options.eye.empty()) SetPoint(options.eye, family.mutable_eye());
    for (const double level : options.levels) family.add_levels(level);
    if (options.count) family.set_count(*options.count);
    if (options.spacing) family.set_spacing_mm(*options.spacing);
    const bool chooses = kind == "highlight" || kind == "brightness";
    family.set_from_normals(options.from_normals && chooses);
    any_chooses = any_chooses || chooses;
  }
  if (options.from_normals && !any_chooses)
    return absl::InvalidArgumentError("--from-normals is for --kind highlight and brightness");
  request.set_tolerance_mm(options.tolerance);
  request.set_min_loop_mm(options.min_loop);
  request.set_picture(picture);
  request.set_name(WireText(std::filesystem::path(options.model).filename().string(), 100));
  request.set_max_threads(options.common.threads);
  return request;
}

void Print(const v1::TraceLinesResponse& response) {
  for (const v1::LineSet& set : response.sets()) {
    int closed = 0;
    for (const v1::SurfaceLine& line : set.lines()) closed += line.closed();
    fmt::print("{:<18} level {:<12.6g} {:>4} lines, {:>4} of them closed, {:.3f} mm\n", Short(set.kind()),
               set.level(), set.lines_size(), closed, set.length_mm());
  }
}

// One point a line: kind, level, number of the line, whether it is closed, x, y, z. Numbers have the
// shortest form that reads back as the same value. A closed line does not repeat its first point.
std::string Table(const v1::TraceLinesResponse& response) {
  std::string text = "kind,level,line,closed,x,y,z\n";
  int number = 0;
  for (const v1::LineSet& set : response.sets()) {
    for (const v1::SurfaceLine& line : set.lines()) {
      ++number;
      for (int i = 0; i + 2 < line.points_mm_size(); i += 3) {
        fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{}\n",
                       absl::AsciiStrToLower(Short(set.kind())), set.level(), number, line.closed() ? 1 : 0,
                       line.points_mm(i), line.points_mm(i + 1), line.points_mm(i + 2));
      }
    }
  }
  return text;
}

absl::Status Run(const LinesOptions& options, InterruptWatch& watch) {
  OutputFile output(options.output, {".json", ".svg", ".csv"});
  absl::StatusOr<v1::TraceLinesRequest> request = MakeRequest(options, output.EndsIn(".svg"));
  if (!request.ok()) return request.status();
  if (const absl::Status writable = CheckWritable({&output}); !writable.ok()) return writable;
  absl::StatusOr<v1::TraceLinesResponse> response =
      Call(options.common, watch, &v1::AnalysisService::Stub::TraceLines, *request);
  if (!response.ok()) return response.status();
  if (output.EndsIn(".csv")) {
    output.Set(Table(*response));
  } else {
    output.Set(output.EndsIn(".svg") ? response->picture().data() : Json(*response));
  }
  if (const absl::Status written = Commit({&output}); !written.ok()) return written;
  if (!options.common.quiet) {
    Print(*response);
    for (const v1::Diagnostic& finding : response->diagnostics()) {
      if (finding.code() == "CURVATURES_ALIKE") fmt::print("  {}\n", Line(finding));
    }
  }
  return absl::OkStatus();
}

void AddVector(CLI::App& app, const char* name, std::vector<double>& value, const char* help) {
  app.add_option(name, value, help)->delimiter(',')->expected(3);
}

}  // namespace

Command AddLines(CLI::App& app) {
  auto options = std::make_shared<LinesOptions>();
  app.add_option("MODEL", options->model, kModelHelp)->required();
  app.add_option("-o,--output", options->output, "the lines: .json, .svg, or .csv with one point a line")
      ->required();
  std::vector<std::string> names;
  for (const auto& [name, kind] : kKinds) names.push_back(name);
  app.add_option("--kind", options->kinds, "kinds of lines, separated by commas")
      ->delimiter(',')
      ->check(CLI::IsMember(names))
      ->capture_default_str();
  app.add_option(
         "--levels", options->levels,
         "levels, separated by commas. contour: mm; slope: degrees; brightness: -1 to 1; highlight: degrees")
      ->delimiter(',');
  app.add_option("--count", options->count, "number of levels to choose when none are given; default 12")
      ->check(CLI::Range(1, 1000));
  AddNumber(app, "--spacing", options->spacing,
            "flow, slope-flow, curvature: distance between neighbouring lines, mm; default: a fortieth of "
            "the diagonal of the box");
  AddVector(app, "--direction", options->direction, "X,Y,Z: axis, light or sight; default 0,0,1");
  AddVector(app, "--across", options->across,
            "X,Y,Z, for --kind highlight: a direction across --direction; default 1,0,0");
  app.add_flag("--from-normals", options->from_normals,
               "highlight, brightness: choose direction and levels, as far as they are not given, from the "
               "normals that\noccur on the surface; flat panels show lines, too");
  AddVector(app, "--eye", options->eye, "X,Y,Z, for --kind eye: place of the eye, mm, program frame");
  AddNumber(app, "--tolerance", options->tolerance, "chord tolerance, mm");
  AddNumber(app, "--min-loop", options->min_loop, "every loop wider than this is found, mm");
  AddReadingOptions(app, options->reading);
  AddSetupOptions(app, options->setup);
  AddCommonOptions(app, options->common);
  return [options](InterruptWatch& watch) { return Run(*options, watch); };
}

}  // namespace patchmill::cli
