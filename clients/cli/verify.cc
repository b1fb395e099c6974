#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include <absl/strings/match.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "clients/cli/commands.h"
#include "clients/cli/input_file.h"
#include "clients/cli/job_options.h"
#include "clients/cli/limit_options.h"
#include "clients/cli/output_file.h"
#include "clients/cli/picture_options.h"
#include "clients/cli/post_options.h"
#include "clients/cli/progress_bar.h"
#include "clients/cli/region_options.h"
#include "clients/cli/scene.h"
#include "clients/cli/text.h"
#include "clients/cli/tool_file.h"
#include "clients/cli/uploading.h"
#include "patchmill/v1/toolpath_service.grpc.pb.h"

namespace patchmill::cli {
namespace {

struct VerifyOptions {
  CommonOptions common;
  SetupOptions setup;
  ReadingOptions reading;
  LimitOptions limits;
  RegionChangeOptions regions;
  std::string model, program, report, preview, tolerance_map, strategy = "auto";
  std::optional<double> tool_diameter;
  std::vector<std::string> tools;
  PictureFlags picture;
  double tolerance = 0.01, leave = 0.0, zigzag_angle = 0.0, steep_angle = 45.0;
  double detail = 0.5, accept_depth = 0.0;
  bool keep_feed = false;
  std::optional<double> scallop, floor, plunge_feed, machine_z_safe;
  bool no_finish = false;
  std::vector<std::string> assume;
  PostOptions post;
  ShankOptions shank;
};

// "2=6": tool 2 has a ball of 6 mm. "BALL_6=6": so has a tool that is called by this name. Else a tool of a
// file.
absl::StatusOr<v1::Tool> ReadTool(const std::string& text) {
  const std::size_t equals = text.find('=');
  double number = 0.0, diameter = 0.0;
  const bool has_number = ReadFinite(text.substr(0, equals), number);
  const bool has_diameter = equals != std::string::npos && ReadFinite(text.substr(equals + 1), diameter);
  if (!has_number && !has_diameter) return ReadToolFile(text);
  const bool good = has_diameter && equals > 0 &&
                    (!has_number || (number >= 1.0 && number <= 99999.0 && number == std::floor(number)));
  if (!good) {
    return absl::InvalidArgumentError(
        fmt::format("--tool {}; must be NUMBER=DIAMETER, as 2=6, with a number from 1 to 99999, or "
                    "NAME=DIAMETER, or FILE[:NUMBER]",
                    text));
  }
  v1::Tool tool;
  if (has_number) {
    tool.set_number(static_cast<int>(number));
  } else {
    tool.set_name(WireText(text.substr(0, equals), 200));
  }
  tool.mutable_ball_end()->set_diameter_mm(diameter);
  return tool;
}

// Gives tools that have only a name the greatest numbers that are free: the program calls them by name.
void NumberTools(v1::VerifyProgramRequest& request) {
  int next = 99999;
  const auto is_taken = [&](int number) {
    return std::any_of(request.tools().begin(), request.tools().end(),
                       [&](const v1::Tool& tool) { return tool.number() == number; });
  };
  for (v1::Tool& tool : *request.mutable_tools()) {
    if (tool.number() != 0 || tool.name().empty()) continue;
    while (is_taken(next)) --next;
    tool.set_number(next);
  }
}

absl::Status SetTools(const VerifyOptions& options, v1::VerifyProgramRequest& request) {
  if (options.tool_diameter) request.add_tools()->mutable_ball_end()->set_diameter_mm(*options.tool_diameter);
  for (const std::string& text : options.tools) {
    absl::StatusOr<v1::Tool> tool = ReadTool(text);
    if (!tool.ok()) return tool.status();
    *request.add_tools() = *std::move(tool);
  }
  if (request.tools_size() > 1) NumberTools(request);
  if (request.tools().empty())
    return absl::InvalidArgumentError("--tool-diameter is missing; set it, or --tool for each tool");
  for (v1::Tool& tool : *request.mutable_tools()) {
    if (const absl::Status set = SetShank(options.shank, tool); !set.ok()) return set;
    if (options.plunge_feed) tool.set_plunge_feed_mm_per_min(*options.plunge_feed);
  }
  return absl::OkStatus();
}

absl::StatusOr<v1::VerifyProgramRequest> MakeRequest(const VerifyOptions& options) {
  v1::VerifyProgramRequest request;
  absl::StatusOr<v1::ModelSource> source = ReadModel(options.model, options.reading);
  if (!source.ok()) return source.status();
  absl::StatusOr<std::string> program = ReadWholeFile(options.program);
  if (!program.ok()) return program.status();
  NameProgram(options.program);
  if (program->empty()) return absl::InvalidArgumentError(fmt::format("{} is empty", options.program));
  absl::StatusOr<v1::Setup> setup = MakeSetup(options.setup, options.reading.length_unit);
  if (!setup.ok()) return setup.status();
  *request.mutable_source() = *std::move(source);
  *request.mutable_setup() = *std::move(setup);
  v1::Selection selection;
  if (const absl::Status set = SetLimits(options.limits, *request.mutable_setup(), selection); !set.ok())
    return set;
  if (Selects(options.limits)) *request.mutable_selection() = std::move(selection);
  if (options.limits.top) request.set_top_z_mm(*options.limits.top);
  request.set_program(*std::move(program));
  absl::StatusOr<ChosenPost> post = ChoosePost(options.post);
  if (!post.ok()) return post.status();
  request.set_dialect(std::move(post->dialect));
  request.set_post_file(std::move(post->post_file));
  if (options.post.control_deviation) request.set_control_deviation_mm(*options.post.control_deviation);
  request.set_assume_exact_path(!options.assume.empty());  // the only one so far
  if (options.machine_z_safe) request.set_machine_z_safe_mm(*options.machine_z_safe);
  if (const absl::Status set = SetTools(options, request); !set.ok()) return set;
  request.set_tolerance_mm(options.tolerance);
  if (options.scallop) request.set_scallop_mm(*options.scallop);
  request.set_stock_to_leave_mm(options.leave);
  request.set_accept_depth_mm(options.accept_depth);
  request.set_keep_feed_on_passes(options.keep_feed);
  if (options.floor) request.set_floor_z_mm(*options.floor);
  request.set_strategy(MakeStrategy(options.strategy));
  request.set_zigzag_angle_deg(options.zigzag_angle);
  request.set_steep_angle_deg(options.steep_angle);
  request.set_detail(options.detail);
  const absl::Status regions =
      SetRegions(options.regions, request.mutable_regions_sha256(), request.mutable_region_overrides());
  if (!regions.ok()) return regions;
  request.set_leftover_map(!options.tolerance_map.empty());
  if (!options.preview.empty()) {
    request.add_outputs(v1::OUTPUT_TESSELLATION);
    request.add_outputs(v1::OUTPUT_PATH_BLOCKS);
  }
  request.set_max_threads(options.common.threads);
  return request;
}

// Whether a region has a scallop of its own.
bool OwnScallops(const RegionChangeOptions& options) {
  return std::any_of(options.changes.begin(), options.changes.end(),
                     [](const std::string& change) { return change.find(":scallop=") != std::string::npos; });
}

void Print(const VerifyOptions& options, const v1::Report& report) {
  fmt::print("outcome   {}\n", Short(report.outcome()));
  if (!report.assumption_codes().empty())
    fmt::print("          only under {}\n", fmt::join(report.assumption_codes(), ", "));
  fmt::print("gouge     {:<11} {:.4f} mm (limit {:g}) at {}\n", Short(report.gouge_check()),
             report.max_gouge_mm(), options.tolerance, Line(report.max_gouge_at()));
  fmt::print(
      "finish    {:<11} {:.4f} mm left{} at {}\n", Short(report.finish_check()), report.max_leftover_mm(),
      options.scallop
          ? fmt::format(" (limit {:g}{})", *options.scallop + options.tolerance,
                        OwnScallops(options.regions) ? ", except for regions with their own scallop" : "")
          : "",
      Line(report.max_leftover_at()));
  if (const std::string spread = SpreadLine(report); !spread.empty()) fmt::print("          {}\n", spread);
  fmt::print("motion    {:<11} steepest descent {:.1f} degrees\n", Short(report.motion_check()),
             report.steepest_descent_deg());
  fmt::print("stock     {}\n", Short(report.stock_check()));
  fmt::print("tip       lowest Z {:.4f}; box {} to {}\n", report.tip_z_min_mm(), Line(report.tip_box().min()),
             Line(report.tip_box().max()));
  const std::string left = UnreachableLine(report);
  fmt::print("uncut     {}{}{}\n", UncutShare(report), left.empty() ? "" : ": ", left);
  for (const v1::Diagnostic& finding : report.diagnostics()) fmt::print("  {}\n", Line(finding));
}

// Exit status 0 needs a finish that was checked, or --no-finish.
absl::Status Verdict(const VerifyOptions& options, v1::Outcome outcome) {
  std::string more;
  switch (outcome) {
    case v1::OUTCOME_COMPLETE:
    case v1::OUTCOME_COMPLETE_WHERE_REACHABLE:
      return absl::OkStatus();
    case v1::OUTCOME_NO_GOUGE_FOUND:
      if (options.no_finish) return absl::OkStatus();
      more = "; the finish was not checked: set --scallop to check it, or --no-finish to leave it out";
      break;
    case v1::OUTCOME_NOTHING_TO_CUT:
      more = "; this ball reaches nothing here that a program could finish";
      break;
    default:
      break;
  }
  return absl::FailedPreconditionError(fmt::format("{}: {}{}", options.program, Short(outcome), more));
}

// The path of a file of the map: its ending replaced.
std::string MapPath(const std::string& path, const char* ending) {
  if (path.empty()) return path;
  const bool ends = absl::EndsWithIgnoreCase(path, ".png") || absl::EndsWithIgnoreCase(path, ".csv");
  return (ends ? path.substr(0, path.size() - 4) : path) + ending;
}

// The part of the page that is known before the answer comes.
Scene BareScene(const VerifyOptions& options, const v1::VerifyProgramRequest& request) {
  Scene scene;
  const auto name = [](const std::string& path) { return std::filesystem::path(path).filename().string(); };
  scene.title = WireText(fmt::format("{} on {}", name(options.program), name(options.model)), 200);
  scene.setup = request.setup();
  scene.tool = request.tools(0);
  scene.tolerance = options.tolerance;
  scene.scallop = options.scallop;
  scene.steep_angle = options.steep_angle;
  scene.program = request.program();
  return scene;
}

// What the server answers, and the files that come with it.
struct VerifyAnswer {
  v1::Report report;
  Scene scene;
  OutputFile map_csv, map_png;
  bool complete = false;
};

void Take(v1::VerifyProgramResponse& response, VerifyAnswer& received) {
  if (response.has_artifact()) {
    const v1::ArtifactChunk& chunk = response.artifact();
    (chunk.name() == "leftover.csv" ? received.map_csv : received.map_png).Append(chunk.data());
  }
  if (response.has_mesh()) received.scene.mesh.push_back(std::move(*response.mutable_mesh()));
  if (response.has_path_block()) received.scene.paths.push_back(std::move(*response.mutable_path_block()));
  if (!response.has_report()) return;
  received.report = response.report();
  received.complete = true;
}

// Forgets the answer of an earlier try.
void Forget(VerifyAnswer& received) {
  received.map_csv.Set("");
  received.map_png.Set("");
  received.scene.mesh.clear();
  received.scene.paths.clear();
  received.report.Clear();
  received.complete = false;
}

absl::Status Receive(const CommonOptions& options, v1::VerifyProgramRequest request, InterruptWatch& watch,
                     VerifyAnswer& received) {
  const absl::Status status =
      SendRequest(options, watch, request, [&](const Connection& connection, const CommonOptions& left) {
        CallScope call(left, watch);
        Forget(received);
        const auto stub = v1::ToolpathService::NewStub(connection.channel);
        const auto reader = stub->VerifyProgram(call.context(), request);
        ProgressBar bar(options.quiet);
        v1::VerifyProgramResponse response;
        while (reader->Read(&response)) {
          if (response.has_progress()) bar.Show(response.progress());
          Take(response, received);
        }
        grpc::Status ended = reader->Finish();
        bar.Clear();
        return ended;
      });
  if (!status.ok()) return status;
  return received.complete ? absl::OkStatus() : absl::DataLossError("the answer ended without a report");
}

absl::Status Run(const VerifyOptions& options, InterruptWatch& watch) {
  OutputFile report_file(options.report);
  OutputFile preview(options.preview, {".png", ".html"});
  const absl::StatusOr<PictureOptions> picture = MakePictureOptions(options.picture);
  if (!picture.ok()) return picture.status();
  if (preview.EndsIn(".html")) {
    if (const absl::Status can = CheckPage(); !can.ok()) return can;
  }
  VerifyAnswer received;
  received.map_csv = OutputFile(MapPath(options.tolerance_map, ".csv"));
  received.map_png = OutputFile(MapPath(options.tolerance_map, ".png"));
  absl::StatusOr<v1::VerifyProgramRequest> request = MakeRequest(options);
  if (!request.ok()) return request.status();
  if (const absl::Status writable =
          CheckWritable({&report_file, &preview, &received.map_csv, &received.map_png});
      !writable.ok())
    return writable;
  received.scene = BareScene(options, *request);
  if (const absl::Status whole = Receive(options.common, *std::move(request), watch, received); !whole.ok())
    return whole;
  if (report_file.wanted()) report_file.Set(Json(received.report));
  absl::StatusOr<std::string> made = std::string();
  if (preview.wanted()) {
    received.scene.report = received.report;
    made = MakePreview(received.scene, preview, *picture);
    // A preview that cannot be made keeps nothing else from being written.
    if (made.ok()) {
      preview.Set(*std::move(made));
    } else {
      preview = OutputFile();
    }
  }
  if (const absl::Status written = Commit({&report_file, &preview, &received.map_csv, &received.map_png});
      !written.ok())
    return written;
  Print(options, received.report);
  if (!made.ok()) return made.status();
  return Verdict(options, received.report.outcome());
}

}  // namespace

Command AddVerify(CLI::App& app) {
  auto options = std::make_shared<VerifyOptions>();
  app.add_option("MODEL", options->model, kModelHelp)->required();
  app.add_option("PROGRAM", options->program, "program text, of Patchmill or of any other source")
      ->required();
  auto* diameter = AddNumber(app, "--tool-diameter", options->tool_diameter,
                             "ball diameter of the one tool of the program, mm; required without --tool");
  app.add_option("--tool", options->tools,
                 "T=D: number or name, and ball diameter (mm), of a tool, or FILE[:NUMBER] as for mill; once "
                 "for each tool of "
                 "the program")
      ->excludes(diameter);
  AddShankOptions(app, options->shank);
  AddNumber(app, "--plunge-feed", options->plunge_feed,
            "highest feed of descents steeper than 30 degrees, mm/min; default: unknown and not checked");
  AddNumber(app, "--tolerance", options->tolerance, "whole error budget and largest allowed gouge, mm");
  auto* scallop =
      AddNumber(app, "--scallop", options->scallop,
                "scallop (cusp) height, mm; without it the leftover is measured but not checked, and "
                "the exit status is 1 unless --no-finish is set");
  app.add_flag("--no-finish", options->no_finish,
               "do not check the finish: exit status 0 if no gouge and no unsafe motion is found")
      ->excludes(scallop);
  AddNumber(app, "--leave", options->leave, "stock to leave along the normal, mm");
  AddNumber(app, "--floor", options->floor,
            "lowest tip, mm, program frame; default: lowest point of the model");
  app.add_option("--strategy", options->strategy, "strategy that the program was forced to")
      ->check(CLI::IsMember({"auto", "contour", "zigzag"}))
      ->capture_default_str();
  AddNumber(app, "--zigzag-angle", options->zigzag_angle,
            "direction of the lines for --strategy zigzag, degrees");
  AddNumber(app, "--steep-angle", options->steep_angle,
            "steep angle that the regions were split by, degrees");
  AddNumber(app, "--detail", options->detail, "detail that the regions were split with")
      ->check(CLI::Range(0.0, 1.0));
  AddRegionChangeOptions(app, options->regions);
  AddLimitOptions(app, options->limits);
  AddReadingOptions(app, options->reading);
  AddSetupOptions(app, options->setup);
  AddStockOptions(app, options->setup);
  app.add_flag("--keep-feed", options->keep_feed,
               "feeds may descend steeply at any feed, where --allowance or --stock states the stock");
  AddNumber(app, "--accept-depth", options->accept_depth,
            "how deep feeds may cut into the --stock, mm, where that is more than --allowance");
  AddPostOptions(app, "--dialect,--post", options->post);
  app.add_option("--assume", options->assume,
                 "what to assume where the program does not say it: path=exact (the control stops at every "
                 "point)")
      ->check(CLI::IsMember({"path=exact"}));
  AddNumber(app, "--machine-z-safe", options->machine_z_safe,
            "machine Z from which up a place of G53 is above everything, mm; default: -10, or machine_top of "
            "the dialect if that is lower");
  app.add_option("--report", options->report, "write the report here (.json)");
  app.add_option("--preview", options->preview,
                 "write a picture in 3-D (.png), or a page that shows part and program in 3-D (.html)");
  AddPictureOptions(app, PictureOf::kProgram, options->picture);
  app.add_option("--tolerance-map", options->tolerance_map,
                 "write what is left over the part: FILE.csv with places and FILE.png from above");
  AddCommonOptions(app, options->common);
  return [options](InterruptWatch& watch) { return Run(*options, watch); };
}

}  // namespace patchmill::cli
