#include <utility>

#include <fmt/format.h>

#include "cam/plan/beside_depth.h"
#include "cam/plan/plan.h"
#include "cam/plan/resolve.h"
#include "cam/post/program_reader.h"
#include "core/base/status.h"
#include "server/convert/enums.h"
#include "server/convert/fields.h"
#include "server/convert/job.h"
#include "server/convert/outline.h"
#include "server/convert/overrides.h"
#include "server/convert/report.h"
#include "server/convert/setup.h"
#include "server/handlers/handlers.h"
#include "server/handlers/prepare.h"
#include "server/limits.h"

namespace patchmill {
namespace {

using Response = v1::VerifyProgramResponse;

void ReadRegions(const v1::VerifyProgramRequest& request, Operation& op, FieldErrors& errors) {
  if (request.has_steep_angle_deg()) op.steep_angle = ReadSteepAngle(request.steep_angle_deg(), "", errors);
  if (request.has_detail()) op.detail = ReadDetail(request.detail(), "", errors);
  ReadOverrides(request.regions_sha256(), request.region_overrides(), "", op, errors);
  for (std::size_t i = 0; i < op.overrides.size() && !request.has_scallop_mm(); ++i) {
    if (op.overrides[i].scallop) {
      errors.Add(fmt::format("region_overrides[{}].scallop_mm", i), "is set without scallop_mm; set both");
    }
  }
}

// The request as a job: set-up, tool, tolerance, stock to leave, floor, strategy.
Job ReadJob(const v1::VerifyProgramRequest& request, FieldErrors& errors) {
  Job job;
  Operation& op = job.operation;
  job.setup = FromProto(request.setup(), "setup", errors);
  if (request.tools().empty()) {
    errors.Missing("tools");
  } else {
    op.tool = FromProto(request.tools(0), "tools[0]", CuttingData::kOptional, errors);
  }
  if (request.tools_size() > 1) errors.NotYet("tools[1]", "send the one tool of the program");
  const double radius = BallRadius(op.tool);
  op.tolerance = request.tolerance_mm();
  Require(errors, "tolerance_mm", op.tolerance,
          op.tolerance >= limits::kMinToleranceMm && op.tolerance <= 0.5 * radius,
          fmt::format("in [{}, half the ball radius = {:.10g}]", limits::kMinToleranceMm, 0.5 * radius));
  if (request.has_scallop_mm()) {
    op.scallop = request.scallop_mm();
    Require(errors, "scallop_mm", op.scallop, op.scallop > 0.0 && op.scallop < radius,
            fmt::format("in (0, ball radius = {:.10g})", radius));
  }
  op.leave = request.stock_to_leave_mm();
  Require(errors, "stock_to_leave_mm", op.leave, op.leave >= 0.0 && op.leave <= limits::kMaxLeaveMm,
          fmt::format("in [0, {}]", limits::kMaxLeaveMm));
  if (request.has_floor_z_mm()) {
    op.floor_z = request.floor_z_mm();
    constexpr double kMost = limits::kMaxCoordinateMm;
    Require(errors, "floor_z_mm", *op.floor_z, std::abs(*op.floor_z) <= kMost,
            fmt::format("in [{}, {}]", -kMost, kMost));
  }
  if (request.has_top_z_mm()) {
    op.top_z = request.top_z_mm();
    constexpr double kMost = limits::kMaxCoordinateMm;
    Require(errors, "top_z_mm", *op.top_z, std::abs(*op.top_z) <= kMost,
            fmt::format("in [{}, {}]", -kMost, kMost));
  }
  op.selection = FromProto(request.selection(), "selection", errors);
  op.strategy = FromProto(request.strategy(), "strategy", errors);
  Require(errors, "zigzag_angle_deg", request.zigzag_angle_deg(),
          std::abs(request.zigzag_angle_deg()) <= 360.0, "in [-360, 360]");
  op.zigzag_angle = Radians(request.zigzag_angle_deg());
  ReadRegions(request, op, errors);
  if (request.program().empty()) errors.Missing("program");
  job.dialect = ReadDialect(request.dialect(), request.post_file(), "", errors);
  if (request.has_control_deviation_mm())
    job.control_deviation = ReadControlDeviation(request.control_deviation_mm(), "", errors);
  job.work_offset.clear();  // a program that is only verified may use any
  return job;
}

// COMPLETE means that the finish was checked, too, and that there was something to finish.
v1::Outcome Judge(const v1::Report& report, bool nothing_to_finish) {
  const bool ok = report.gouge_check() == v1::CHECK_STATE_PASSED &&
                  report.motion_check() == v1::CHECK_STATE_PASSED &&
                  report.finish_check() != v1::CHECK_STATE_FAILED;
  if (!ok) return v1::OUTCOME_VERIFICATION_FAILED;
  if (report.finish_check() != v1::CHECK_STATE_PASSED) return v1::OUTCOME_NO_GOUGE_FOUND;
  if (nothing_to_finish) return v1::OUTCOME_NOTHING_TO_CUT;
  return report.unreachable_area_mm2() > 0.0 ? v1::OUTCOME_COMPLETE_WHERE_REACHABLE : v1::OUTCOME_COMPLETE;
}

// Number of rapids that follow a feed move.
int RetractCount(const ProgramMotion& motion) {
  int count = 0;
  for (std::size_t i = 1; i < motion.moves.size(); ++i) {
    count += motion.moves[i].kind == ProgramMove::Kind::kRapid &&
             motion.moves[i - 1].kind == ProgramMove::Kind::kFeed;
  }
  return count;
}

absl::Status Make(const Call& call, const v1::VerifyProgramRequest& request, Job job, const RunContext& run,
                  v1::Report* report) {
  run.Progress("model", 0.0);
  PM_ASSIGN_OR_RETURN(LoadedModel model, LoadModel(request.source(), "source", run, &call.env->in_flight));
  PM_RETURN_IF_ERROR(RequireSound(model));
  PM_RETURN_IF_ERROR(run.Check());
  absl::StatusOr<ProgramMotion> motion = ReadProgram(
      request.program(), {.run = &run, .dialect = job.dialect, .control_deviation = job.control_deviation});
  if (!motion.ok()) {
    if (motion.status().code() != absl::StatusCode::kInvalidArgument) return motion.status();
    return ProgramUnreadableError("program: " + std::string(motion.status().message()));
  }
  PM_RETURN_IF_ERROR(run.Check());
  PM_ASSIGN_OR_RETURN(UprightModel upright, MakeUpright(std::move(model), job.setup, run));
  job.setup = std::move(upright.setup);
  PM_ASSIGN_OR_RETURN(const Surface surface,
                      BuildPlacedSurface(std::move(upright.model.model), job.setup, run));
  PM_ASSIGN_OR_RETURN(const Resolved resolved, Resolve(surface, job, run));
  PM_ASSIGN_OR_RETURN(const std::vector<PlanPart> parts, VerifiedParts(surface, job, resolved, run));
  VerifyParams params = MakeVerifyParams(job, resolved, parts);
  if (!request.has_scallop_mm()) {
    params.finish.scallop.reset();
    for (FinishPart& part : params.parts) part.finish.scallop.reset();
  }
  PM_ASSIGN_OR_RETURN(const VerifyReport verify, Verify(surface, job.operation.tool, *motion, params, run));
  FillFromVerifier(verify, resolved.program_zero, request.has_scallop_mm(), report);
  report->set_outcome(Judge(*report, verify.NothingToFinish()));
  *report->mutable_setup_sheet() = ToProto(resolved, job);
  report->mutable_setup_sheet()->set_tool_number(motion->tool_number);
  report->mutable_setup_sheet()->clear_clearance_z_mm();
  report->set_point_count(static_cast<int>(motion->moves.size()));
  report->set_retract_count(RetractCount(*motion));
  if (std::isfinite(motion->controller_tolerance))
    report->set_controller_tolerance_mm(motion->controller_tolerance);
  report->set_time_basis("not estimated");
  if (!request.has_scallop_mm()) {
    AddDiagnostics(
        {MakeWarning("FINISH_NOT_CHECKED",
                     "no scallop is given: the finish is not checked, nor whether the program cuts anything",
                     {.field = "scallop_mm"})},
        resolved.program_zero, report->mutable_diagnostics());
  }
  AddDiagnostics(HeaderRemarks(upright.model.remarks), resolved.program_zero, report->mutable_diagnostics());
  AddDiagnostics(WallsWithoutSide(surface), resolved.program_zero, report->mutable_diagnostics());
  PM_ASSIGN_OR_RETURN(const Diagnostics beside,
                      FindToolBesidePart(surface, TipsOf(*motion, resolved.program_zero), resolved.radius,
                                         resolved.program_zero, run));
  AddDiagnostics(beside, resolved.program_zero, report->mutable_diagnostics());
  AddDiagnostics(verify.findings, resolved.program_zero, report->mutable_diagnostics());
  return absl::OkStatus();
}

}  // namespace

absl::Status HandleVerifyProgram(const Call& call, const v1::VerifyProgramRequest& request,
                                 const Sink<Response>& sink) {
  PM_RETURN_IF_ERROR(RefuseUnknownFields(request));
  PM_RETURN_IF_ERROR(CheckThreads(request.max_threads(), "max_threads"));
  FieldErrors errors;
  const Job job = ReadJob(request, errors);
  PM_RETURN_IF_ERROR(errors.ToStatus());
  const auto beat = [&](std::string_view stage, double fraction) {
    Response response;
    response.mutable_progress()->set_stage(std::string(stage));
    response.mutable_progress()->set_fraction(fraction);
    return sink(response);
  };
  Response last;
  PM_RETURN_IF_ERROR(RunJobThread(call, request.max_threads(), beat, [&](const RunContext& run) {
    return Make(call, request, job, run, last.mutable_report());
  }));
  return sink(last) ? absl::OkStatus() : absl::CancelledError("the client has gone");
}

}  // namespace patchmill
