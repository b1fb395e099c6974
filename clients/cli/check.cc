#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "clients/cli/call.h"
#include "clients/cli/commands.h"
#include "clients/cli/job_options.h"
#include "clients/cli/part_tables.h"
#include "clients/cli/text.h"
#include "patchmill/v1/model_service.grpc.pb.h"

namespace patchmill::cli {
namespace {

struct CheckOptions {
  CommonOptions common;
  SetupOptions setup;
  ReadingOptions reading;
  std::string model;
  double tool_diameter = 6.0;
  int continuity = 0;
  bool all_findings = false;
  bool no_crossings = false;
};

void Print(const CheckOptions& options, const v1::CheckModelResponse& response) {
  if (response.face_count() > 0) fmt::print("faces        {}\n", response.face_count());
  fmt::print("patches      {}\n", response.patch_count());
  if (response.has_box()) {
    fmt::print("box          {} to {} mm\n", Line(response.box().min()), Line(response.box().max()));
    fmt::print("edges        {} joined, {} open (join tolerance {:.3g} mm)\n", response.joined_edge_count(),
               response.open_edge_count(), response.join_tolerance_mm());
    fmt::print("continuity   gaps up to {:.3g} mm, normals up to {:.3f} degrees apart\n",
               response.max_gap_mm(), response.max_angle_deg());
    if (response.face_count() > 0) {
      fmt::print("sharp edges  {:.4g} mm stick out, {:.4g} mm are inner corners\n",
                 response.convex_edge_length_mm(), response.concave_edge_length_mm());
    }
    const double radius = 0.5 * options.tool_diameter;
    const bool tighter =
        std::any_of(response.diagnostics().begin(), response.diagnostics().end(),
                    [](const v1::Diagnostic& d) { return d.code() == "CONCAVE_RADIUS_BELOW_TOOL"; });
    if (!response.has_min_concave_radius_mm()) {
      fmt::print("concave      nowhere\n");
    } else {
      fmt::print("concave      smallest radius {:.4g} mm, {} the ball's {:.4g} mm\n",
                 response.min_concave_radius_mm(), tighter ? "TIGHTER than" : "not tighter than", radius);
    }
  }
  PrintConcaveFaces(response, options.all_findings);
  PrintHoles(response, options.all_findings);
  PrintUpDirections(response);
  // The largest angles come first.
  std::vector<v1::EdgeContinuity> joints(response.joints().begin(), response.joints().end());
  std::stable_sort(joints.begin(), joints.end(),
                   [](const auto& a, const auto& b) { return a.max_angle_deg() > b.max_angle_deg(); });
  for (const v1::EdgeContinuity& joint : joints) {
    fmt::print("joint        edge {} of patch {} and {}edge {} of patch {}: gap {:.3g} mm, {:.3g} degrees",
               joint.edge(), joint.patch_index(), joint.part() ? "a part of " : "", joint.other_edge(),
               joint.other_patch_index(), joint.max_gap_mm(), joint.max_angle_deg());
    if (joint.max_curvature_per_mm() > 0.0) {
      fmt::print(", curvatures up to {:.3g}/mm differ by {:.3g}/mm", joint.max_curvature_per_mm(),
                 joint.max_curvature_gap_per_mm());
    }
    fmt::print("\n");
  }
  fmt::print("findings     {}\n", response.diagnostics_size());
  for (const std::string& line : FindingLines(response.diagnostics(), options.all_findings))
    fmt::print("  {}\n", line);
}

absl::Status Run(const CheckOptions& options, InterruptWatch& watch) {
  v1::CheckModelRequest request;
  absl::StatusOr<v1::ModelSource> source = ReadModel(options.model, options.reading);
  if (!source.ok()) return source.status();
  absl::StatusOr<v1::Setup> setup = MakeSetup(options.setup);
  if (!setup.ok()) return setup.status();
  *request.mutable_source() = *std::move(source);
  *request.mutable_setup() = *std::move(setup);
  request.mutable_tool()->mutable_ball_end()->set_diameter_mm(options.tool_diameter);
  request.set_max_threads(options.common.threads);
  request.set_continuity_steps(options.continuity);
  request.set_with_crossings(!options.no_crossings);
  absl::StatusOr<v1::CheckModelResponse> response =
      Call(options.common, watch, &v1::ModelService::Stub::CheckModel, request);
  if (!response.ok()) return response.status();
  Print(options, *response);
  const int errors = CountErrors(response->diagnostics());
  if (errors == 0) return absl::OkStatus();
  return absl::FailedPreconditionError(
      fmt::format("{}: {} errors; the model cannot be milled", options.model, errors));
}

}  // namespace

Command AddCheck(CLI::App& app) {
  auto options = std::make_shared<CheckOptions>();
  app.add_option("MODEL", options->model, kModelHelp)->required();
  AddNumber(app, "--tool-diameter", options->tool_diameter,
            "ball diameter that concave curvature is compared with, mm");
  app.add_option("--continuity", options->continuity,
                 "list every joint, measured at this many equal steps of its edge")
      ->check(CLI::Range(0, 10000));
  app.add_flag("--all-findings", options->all_findings,
               "list every finding, concave face and hole, not just the first few");
  app.add_flag("--no-crossings", options->no_crossings, "do not look for patches that cross each other");
  AddReadingOptions(app, options->reading);
  AddSetupOptions(app, options->setup);
  AddCommonOptions(app, options->common);
  return [options](InterruptWatch& watch) { return Run(*options, watch); };
}

}  // namespace patchmill::cli
