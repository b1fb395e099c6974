#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include <absl/strings/match.h>
#include <fmt/format.h>

#include "clients/cli/commands.h"
#include "clients/cli/job_options.h"
#include "clients/cli/limit_options.h"
#include "clients/cli/output_file.h"
#include "clients/cli/picture_options.h"
#include "clients/cli/post_options.h"
#include "clients/cli/progress_bar.h"
#include "clients/cli/region_options.h"
#include "clients/cli/scene.h"
#include "clients/cli/text.h"
#include "clients/cli/uploading.h"
#include "patchmill/v1/toolpath_service.grpc.pb.h"

namespace patchmill::cli {
namespace {

constexpr int kMaxReasons = 5;  // lines on the terminal

struct MillOptions {
  CommonOptions common;
  SetupOptions setup;
  ReadingOptions reading;
  OperationOptions operation;
  LimitOptions limits;
  RegionChangeOptions regions;
  std::string model, program, report, work_offset = "G54";
  std::vector<std::string> previews;
  PictureFlags picture;
  PostOptions post;
  bool no_arcs = false, inch = false, restart_points = false;
  std::optional<int> line_numbers;
  int program_number = 1;
};

// The part of the stream received so far. It goes to disk only after the report.
struct Received {
  OutputFile program, report_file, plan, picture, page;
  Scene scene;
  v1::Report report;
  bool complete = false;  // the report has come; a stream without it is void
};

// A plan (.svg) is drawn by the server; a picture (.png) and a page (.html) are made here of the same data.
enum class Preview { kPlan, kPicture, kPage };

Preview KindOf(const std::string& path) {
  if (absl::EndsWithIgnoreCase(path, ".html")) return Preview::kPage;
  return absl::EndsWithIgnoreCase(path, ".png") ? Preview::kPicture : Preview::kPlan;
}

absl::StatusOr<v1::GenerateProgramRequest> MakeRequest(const MillOptions& options) {
  v1::GenerateProgramRequest request;
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
  absl::StatusOr<ChosenPost> post = ChoosePost(options.post);
  if (!post.ok()) return post.status();
  request.mutable_post()->set_dialect(std::move(post->dialect));
  request.mutable_post()->set_post_file(std::move(post->post_file));
  if (options.no_arcs) request.mutable_post()->set_arcs(false);
  if (options.inch) request.mutable_post()->set_unit(v1::LENGTH_UNIT_INCH);
  request.mutable_post()->set_restart_points(options.restart_points);
  if (options.line_numbers) request.mutable_post()->set_line_number_step(*options.line_numbers);
  request.mutable_post()->set_program_number(options.program_number);
  if (options.post.control_deviation)
    request.mutable_post()->set_control_deviation_mm(*options.post.control_deviation);
  request.mutable_post()->set_work_offset(WireText(options.work_offset, 100));
  for (const v1::Output output : {v1::OUTPUT_PROGRESS, v1::OUTPUT_PROGRAM, v1::OUTPUT_REPORT}) {
    request.add_outputs(output);
  }
  bool in_3d = false;
  for (const std::string& path : options.previews) {
    if (KindOf(path) == Preview::kPlan) request.add_outputs(v1::OUTPUT_PICTURE);
    in_3d = in_3d || KindOf(path) != Preview::kPlan;
  }
  if (in_3d) {
    for (const v1::Output output : {v1::OUTPUT_REGIONS, v1::OUTPUT_PATH_BLOCKS, v1::OUTPUT_TESSELLATION})
      request.add_outputs(output);
  }
  request.set_max_threads(options.common.threads);
  return request;
}

void Take(v1::GenerateProgramResponse& response, ProgressBar& bar, Received& received) {
  switch (response.event_case()) {
    case v1::GenerateProgramResponse::kProgress:
      bar.Show(response.progress());
      break;
    case v1::GenerateProgramResponse::kProgram:
      received.program.Append(response.program().data());
      if (received.page.wanted()) received.scene.program += response.program().data();
      break;
    case v1::GenerateProgramResponse::kArtifact:
      received.plan.Append(response.artifact().data());
      break;
    case v1::GenerateProgramResponse::kAccepted:
      received.scene.setup = response.accepted().resolved_job().setup();
      break;
    case v1::GenerateProgramResponse::kRegions:
      received.scene.regions = std::move(*response.mutable_regions());
      break;
    case v1::GenerateProgramResponse::kMesh:
      received.scene.mesh.push_back(std::move(*response.mutable_mesh()));
      break;
    case v1::GenerateProgramResponse::kPathBlock:
      received.scene.paths.push_back(std::move(*response.mutable_path_block()));
      break;
    case v1::GenerateProgramResponse::kReport:
      received.report = response.report();
      received.complete = true;
      break;
    default:
      break;
  }
}

// At most one of each kind.
absl::Status SetPreviews(const std::vector<std::string>& paths, Received& received) {
  for (const std::string& path : paths) {
    const Preview kind = KindOf(path);
    OutputFile& file = kind == Preview::kPage      ? received.page
                       : kind == Preview::kPicture ? received.picture
                                                   : received.plan;
    if (file.wanted()) {
      return absl::InvalidArgumentError(
          fmt::format("--preview {} and {}; one .svg, one .png and one .html at most", file.path(), path));
    }
    file = OutputFile(path, {".svg", ".png", ".html"});
  }
  return received.page.wanted() ? CheckPage() : absl::OkStatus();
}

bool CarriesProgram(const v1::Report& report) {
  return report.outcome() == v1::OUTCOME_COMPLETE || report.outcome() == v1::OUTCOME_COMPLETE_WHERE_REACHABLE;
}

// Why a job has no program.
absl::Status NoProgram(const MillOptions& options, const v1::Report& report) {
  std::string message = fmt::format("{}: {}", options.model, Short(report.outcome()));
  int reasons = 0;
  for (const v1::Diagnostic& finding : report.diagnostics()) {
    if (finding.severity() != v1::SEVERITY_ERROR && finding.code() != Short(report.outcome())) continue;
    if (++reasons <= kMaxReasons) message += "\n  " + Line(finding);
  }
  if (reasons > kMaxReasons)
    message += fmt::format("\n  and {} more; --report has them", reasons - kMaxReasons);
  if (!report.unreachable().empty()) message += fmt::format("\n  not reached: {}", UncutShare(report));
  return absl::FailedPreconditionError(message + "\n  no program was written");
}

// Report and picture of a failed job are written, its program is not.
absl::Status WriteFiles(const MillOptions& options, const PictureOptions& picture, Received& received) {
  const bool has_program = CarriesProgram(received.report);
  if (has_program &&
      received.program.size() != static_cast<std::size_t>(received.report.program_size_bytes())) {
    return absl::DataLossError("the program did not arrive whole; nothing was written");
  }
  if (!has_program) received.program = OutputFile();
  received.report_file.Set(Json(received.report));
  received.scene.report = received.report;
  // A preview that cannot be made keeps nothing else from being written.
  absl::Status previews;
  const auto set = [&](OutputFile& file, absl::StatusOr<std::string> made) {
    if (made.ok()) return file.Set(*std::move(made));
    previews.Update(made.status());
    file = OutputFile();
  };
  if (received.page.wanted()) set(received.page, MakePage(received.scene));
  if (received.picture.wanted()) set(received.picture, MakePicture(received.scene, picture));
  if (const absl::Status written = Commit(
          {&received.report_file, &received.plan, &received.picture, &received.page, &received.program});
      !written.ok())
    return written;
  return has_program ? previews : NoProgram(options, received.report);
}

// ", 4.1 m less if --allowance states the stock"; empty if that would save little.
std::string SavedRapids(const v1::Report& report) {
  const double saved = report.rapids_saved_by_stated_stock_mm();
  if (saved < 100.0) return "";
  return fmt::format(", {:.1f} m less if --allowance states the stock", saved / 1000.0);
}

// "12 arcs (11 of the whole radius, least 0.75 mm), 1 ramp".
std::string LeadsLine(const v1::LeadFigures& leads) {
  std::string line = fmt::format("{} arcs", leads.arc_count());
  if (leads.arc_count() > 0) {
    line += fmt::format(" ({} of the whole radius, least {:.3g} mm; {} with a way back)",
                        leads.whole_radius_count(), leads.least_radius_mm(), leads.back_count());
  }
  return line + fmt::format(", {} ramps, {} steep, {} straight off passes", leads.ramp_count(),
                            leads.steep_count(), leads.straight_out_count());
}

// "12 % above the lower bound for this finish".
std::string OverLeast(const v1::Report& report) {
  const double least = report.least_cut_length_mm();
  if (!(least > 0.0)) return "no lower bound is known";
  return fmt::format("{:.0f} % above the lower bound for this finish",
                     100.0 * (report.cut_length_mm() / least - 1.0));
}

bool IsToCheckBeforeStart(const v1::Report& report, const v1::Diagnostic& finding) {
  const auto& codes = report.check_before_start_codes();
  return std::find(codes.begin(), codes.end(), finding.code()) != codes.end();
}

// Warnings that say no more than what the options say.
bool RepeatsOptions(const v1::Diagnostic& finding) {
  return finding.code() == "STOCK_STATED" || finding.code() == "LOW_RAPIDS";
}

// Whether there may be many findings of this code, one for each place.
bool OfManyPlaces(const v1::Diagnostic& finding) {
  return finding.where().has_patch_index() || finding.code() == "STEEP_LEAD";
}

// Prints the warnings, but what is to be checked before the start. Those of the same code about single places
// are one line: the first, with the number of the others.
void PrintWarnings(const v1::Report& report, bool all) {
  std::map<std::string, int> of_patches;
  for (const v1::Diagnostic& finding : report.diagnostics()) {
    if (finding.severity() != v1::SEVERITY_INFO && OfManyPlaces(finding)) ++of_patches[finding.code()];
  }
  for (const v1::Diagnostic& finding : report.diagnostics()) {
    const bool answers = finding.code() == "UP_CHOSEN" && all;  // what the options left open
    if (answers) fmt::print(stderr, "  {}\n", Line(finding));
    if (finding.severity() == v1::SEVERITY_INFO || IsToCheckBeforeStart(report, finding)) continue;
    if (!all && RepeatsOptions(finding)) continue;
    if (!OfManyPlaces(finding)) {
      fmt::print(stderr, "  {}\n", Line(finding));
    } else if (const auto first = of_patches.extract(finding.code())) {
      const std::string more = first.mapped() > 1 ? fmt::format(", and {} more", first.mapped() - 1) : "";
      fmt::print(stderr, "  {}{}\n", Line(finding), more);
    }
  }
}

void PrintSummary(const MillOptions& options, const v1::Report& report) {
  const std::string left = UnreachableLine(report);
  if (!left.empty()) {
    fmt::print(stderr, "patchmill: not reached: {}: {}\n", UncutShare(report), left);
  }
  if (options.common.quiet) {
    PrintWarnings(report, false);
    return;
  }
  const v1::SetupSheet& sheet = report.setup_sheet();
  fmt::print(stderr, "{}: {}, verified\n", options.program, Short(report.outcome()));
  fmt::print(stderr, "  gouge     {:.4f} mm at {}\n", report.max_gouge_mm(), Line(report.max_gouge_at()));
  fmt::print(stderr, "  tip       lowest Z {:.4f}; box {} to {}\n", report.tip_z_min_mm(),
             Line(report.tip_box().min()), Line(report.tip_box().max()));
  fmt::print(stderr, "  set-up    T{} D {:g}, {}, stick-out at least {:.1f} mm, clearance Z {:.3f}\n",
             sheet.tool_number(), sheet.tool_diameter_mm(), sheet.work_offset(),
             report.required_stickout_mm(), sheet.clearance_z_mm());
  fmt::print(stderr, "  leftover  {:.4f} mm at {}\n", report.max_leftover_mm(),
             Line(report.max_leftover_at()));
  fmt::print(stderr, "            {}\n", SpreadLine(report));
  if (report.underside_area_mm2() > 0.0) {
    fmt::print(stderr, "            {:.2f} mm2 of the part look down and do not count\n",
               report.underside_area_mm2());
  }
  if (const std::string skipped = SkippedLine(report); !skipped.empty()) {
    fmt::print(stderr, "  skipped   {}\n", skipped);
  }
  fmt::print(stderr, "  motion    {:.1f} min ({}), {} retracts\n", report.estimated_time_s() / 60.0,
             report.time_basis(), report.retract_count());
  fmt::print(stderr, "            {} feed blocks, {} of them arcs, {:.3g} points per mm\n",
             report.feed_block_count(), report.arc_block_count(), report.points_per_mm());
  fmt::print(stderr, "            {:.1f} m of feed, {}; {:.1f} m of rapids{}\n",
             report.cut_length_mm() / 1000.0, OverLeast(report), report.rapid_length_mm() / 1000.0,
             SavedRapids(report));
  if (report.corner_feed_length_mm() > 0.0)
    fmt::print(stderr, "            {:.2f} m of it slower in inner corners\n",
               report.corner_feed_length_mm() / 1000.0);
  fmt::print(stderr, "  leads     {}\n", LeadsLine(report.leads()));
  if (report.certificate_defect_count() > 0) {
    fmt::print(stderr,
               "  heights   {} corrected by their certificates: a defect of the planner, please report\n",
               report.certificate_defect_count());
  }
  PrintWarnings(report, true);
  if (!report.check_before_start_codes().empty()) fmt::print(stderr, "  assumed: check before start\n");
  for (const v1::Diagnostic& finding : report.diagnostics()) {
    if (IsToCheckBeforeStart(report, finding))
      fmt::print(stderr, "    {}: {}\n", finding.code(), finding.message());
  }
}

// Forgets the answer of an earlier try.
void Forget(Received& received) {
  received.program.Set("");
  received.plan.Set("");
  received.scene.program.clear();
  received.scene.regions.Clear();
  received.scene.mesh.clear();
  received.scene.paths.clear();
  received.report.Clear();
  received.complete = false;
}

absl::Status Receive(const CommonOptions& options, v1::GenerateProgramRequest request, InterruptWatch& watch,
                     Received& received) {
  const absl::Status status =
      SendRequest(options, watch, request, [&](const Connection& connection, const CommonOptions& left) {
        CallScope call(left, watch);
        Forget(received);
        const auto stub = v1::ToolpathService::NewStub(connection.channel);
        ProgressBar bar(options.quiet);
        const auto reader = stub->GenerateProgram(call.context(), request);
        v1::GenerateProgramResponse response;
        while (reader->Read(&response)) Take(response, bar, received);
        grpc::Status ended = reader->Finish();
        bar.Clear();
        return ended;
      });
  if (!status.ok()) return status;
  return received.complete ? absl::OkStatus()
                           : absl::DataLossError("the answer ended without a report; nothing was written");
}

absl::Status Run(const MillOptions& options, InterruptWatch& watch) {
  Received received;
  received.program = OutputFile(options.program);
  received.report_file = OutputFile(options.report);
  if (const absl::Status set = SetPreviews(options.previews, received); !set.ok()) return set;
  const absl::StatusOr<PictureOptions> picture = MakePictureOptions(options.picture);
  if (!picture.ok()) return picture.status();
  absl::StatusOr<v1::GenerateProgramRequest> request = MakeRequest(options);
  if (!request.ok()) return request.status();
  if (const absl::Status writable = CheckWritable(
          {&received.program, &received.report_file, &received.plan, &received.picture, &received.page});
      !writable.ok())
    return writable;
  const v1::Operation& operation = request->job().operations(0);
  received.scene.title = request->job().name();
  received.scene.tool = operation.tool();
  received.scene.tolerance = options.operation.tolerance;
  received.scene.scallop = operation.scallop_mm();
  received.scene.steep_angle = options.operation.steep_angle;
  if (const absl::Status whole = Receive(options.common, *std::move(request), watch, received); !whole.ok())
    return whole;
  if (const absl::Status written = WriteFiles(options, *picture, received); !written.ok()) return written;
  PrintSummary(options, received.report);
  return absl::OkStatus();
}

void AddOperationOptions(CLI::App& app, OperationOptions& op) {
  AddSplitOptions(app, op);
  app.add_option("--strategy", op.strategy,
                 "contours on steep and zig-zag lines on gentle areas (auto), or one of them everywhere")
      ->check(CLI::IsMember({"auto", "contour", "zigzag"}))
      ->capture_default_str();
  AddNumber(app, "--zigzag-angle", op.zigzag_angle,
            "direction of zig-zag lines from +X, counter-clockwise, degrees");
  AddNumber(
      app, "--bend", op.bend,
      "how far lines may turn from that direction to keep the step-over even, degrees, 0 to 30; 0: straight");
  app.add_flag(
      "--auto-angle", op.auto_angle,
      "run the lines of each region in the direction that takes the least time, to within 4 degrees");
  app.add_flag("--one-way", op.one_way, "cut all lines in that direction, with retracts in between");
  app.add_flag("--spirals", op.spirals, "wind closed contours around walls into one helical pass");
  app.add_flag("--no-round-lines", op.no_round_lines,
               "straight lines on rims and shoulders, too, where circular lines would be a tenth shorter");
  app.add_flag("--no-border-passes", op.no_border_passes,
               "no passes along borders where zig-zag lines end one after the other");
  app.add_option("--edges", op.edges,
                 "open edges: stop at them, roll over them, or extend passes by a ball radius beyond them")
      ->check(CLI::IsMember({"stop", "roll", "extend"}))
      ->capture_default_str();
  app.add_option(
         "--direction", op.direction,
         "direction of contours; either: open ones run back and forth, with fewer retracts. Links along\n"
         "the surface may run in any direction")
      ->check(CLI::IsMember({"climb", "conventional", "either"}))
      ->capture_default_str();
  AddNumber(app, "--clearance", op.clearance,
            "clearance plane: tip height of rapids above the highest of model, stock and obstacles, mm");
  AddNumber(app, "--feed", op.feed, "cutting feed, mm/min; default 1200 at D 6, with a warning");
  AddNumber(app, "--plunge-feed", op.plunge_feed,
            "feed of steep descents, mm/min; default a third of the feed, with a warning");
  AddNumber(app, "--spindle", op.spindle, "spindle speed, rpm; default 12000 at D 6, with a warning");
  app.add_option("--coolant", op.coolant, "coolant while cutting")
      ->check(CLI::IsMember({"off", "flood", "mist", "air"}))
      ->capture_default_str();
  app.add_option("--tool-number", op.tool_number, "number of the T word; default 1, or that of --tool");
  AddShankOptions(app, op.shank);
}

// The motion between passes.
void AddMotionOptions(CLI::App& app, OperationOptions& op) {
  app.add_flag(
      "--high-rapids", op.high_rapids,
      "all rapids at the clearance plane; else they are only as high as needed to clear the stock over "
      "the\nwhole rectangle between their ends, where --allowance or --stock states it");
  app.add_flag("--low-rapids", op.low_rapids, "without effect: rapids are low where the stock is stated");
  AddNumber(app, "--accept-depth", op.accept_depth,
            "how deep passes may cut into the --stock, mm, where that is more than --allowance");
  AddNumber(app, "--max-unreached", op.max_unreached,
            "largest share of what looks up that may stay uncut because the ball does not fit, percent; "
            "default 50");
  AddNumber(app, "--approach-gap", op.approach_gap,
            "distance from the stock at which a rapid changes to feed, mm; default 1");
  AddNumber(app, "--lead-radius", op.lead_radius,
            "radius of the arcs onto passes and off them, mm; default half the ball radius");
  AddNumber(app, "--lead-sweep", op.lead_sweep, "sweep of these arcs, degrees, 10 to 90; default 90");
  AddNumber(app, "--lead-feed", op.lead_feed, "feed of leads, mm/min; default --feed");
  AddNumber(app, "--link-feed", op.link_feed, "feed of links between passes, mm/min; default --feed");
  AddNumber(app, "--corner-feed", op.corner_feed,
            "lowest feed in inner corners of passes, mm/min: the feed falls there so that the ball cuts no "
            "faster than\n"
            "at --feed along a straight wall; default: corners run at --feed");
  app.add_flag(
      "--keep-feed", op.keep_feed,
      "passes keep the feed on steep descents: they cut no deeper than --allowance, which must be given");
  AddNumber(app, "--plunge-angle", op.plunge_angle,
            "descents steeper than this run at plunge feed, degrees, 1 to 30; default 30");
}

}  // namespace

Command AddMill(CLI::App& app) {
  auto options = std::make_shared<MillOptions>();
  app.add_option("MODEL", options->model, kModelHelp)->required();
  app.add_option("-o,--output", options->program,
                 "file of the program; it is written once the program is verified")
      ->required();
  AddOperationOptions(app, options->operation);
  AddRegionChangeOptions(app, options->regions);
  AddLimitOptions(app, options->limits);
  AddReadingOptions(app, options->reading);
  AddSetupOptions(app, options->setup);
  AddStockOptions(app, options->setup);
  AddMotionOptions(app, options->operation);
  app.add_option("--work-offset", options->work_offset, "work offset, G54 to G59")->capture_default_str();
  AddPostOptions(app, "--post", options->post);
  app.add_flag("--no-arcs", options->no_arcs,
               "straight moves only (G1), also where the dialect has arcs (G2, G3)");
  app.add_flag("--inch", options->inch,
               "write the program in inches (G20); options, reports and pictures stay in mm");
  app.add_flag("--restart-points", options->restart_points,
               "write places where the control may be started again: from above, with spindle and modes");
  app.add_option("--line-numbers", options->line_numbers,
                 "step of the line numbers (N10, N20, ...); 0: none; default as the control has them")
      ->check(CLI::Range(0, 1000));
  app.add_option("--program-number", options->program_number,
                 "number of the program, for dialects that number their programs")
      ->check(CLI::Range(1, 9999))
      ->capture_default_str();
  app.add_option("--report", options->report, "write the report here (.json)");
  app.add_option(
         "--preview", options->previews,
         "write a plan here (.svg), a picture in 3-D (.png), or a page that shows part and program in 3-D\n"
         "(.html); one of each at most")
      ->allow_extra_args(false);
  AddPictureOptions(app, PictureOf::kProgram, options->picture);
  AddCommonOptions(app, options->common);
  return [options](InterruptWatch& watch) { return Run(*options, watch); };
}

}  // namespace patchmill::cli
