#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <absl/strings/ascii.h>
#include <fmt/format.h>

#include "cam/plan/beside_depth.h"
#include "cam/plan/drawing.h"
#include "cam/plan/plan.h"
#include "cam/plan/resolve.h"
#include "cam/post/program_reader.h"
#include "cam/verify/join_reports.h"
#include "cam/verify/tool_moves.h"
#include "core/base/status.h"
#include "server/convert/drawing.h"
#include "server/convert/enums.h"
#include "server/convert/fields.h"
#include "server/convert/job.h"
#include "server/convert/leftover_map.h"
#include "server/convert/outline.h"
#include "server/convert/overrides.h"
#include "server/convert/report.h"
#include "server/convert/setup.h"
#include "server/handlers/handlers.h"
#include "server/handlers/outputs.h"
#include "server/handlers/prepare.h"
#include "server/limits.h"
#include "server/placed_surface.h"

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

// The tools by their numbers. A single one is that of the whole program, whatever its number.
std::vector<Tool> ReadTools(const v1::VerifyProgramRequest& request, FieldErrors& errors) {
  std::vector<Tool> tools;
  if (request.tools().empty()) errors.Missing("tools");
  if (request.tools_size() > limits::kMaxTools) {
    errors.Add("tools", fmt::format("has {}; at most {}", request.tools_size(), limits::kMaxTools));
    return tools;
  }
  for (int i = 0; i < request.tools_size(); ++i) {
    const std::string field = fmt::format("tools[{}]", i);
    tools.push_back(FromProto(request.tools(i), field, CuttingData::kOptional, errors));
    const bool again = std::any_of(tools.begin(), tools.end() - 1,
                                   [&](const Tool& t) { return t.number == tools.back().number; });
    if (again) errors.Add(field + ".number", fmt::format("= {}; another tool has it", tools.back().number));
    const std::string name = absl::AsciiStrToLower(tools.back().name);
    const bool same_name = !name.empty() && std::any_of(tools.begin(), tools.end() - 1, [&](const Tool& t) {
      return absl::AsciiStrToLower(t.name) == name;
    });
    if (same_name) errors.Add(field + ".name", "is that of another tool; capital letters do not count");
  }
  if (tools.size() > 1 && !request.region_overrides().empty())
    errors.Add("region_overrides", "is set with several tools; regions are those of one tool");
  return tools;
}

// The request as a job of its smallest tool: set-up, tool, tolerance, stock to leave, floor, strategy.
Job ReadJob(const v1::VerifyProgramRequest& request, const std::vector<Tool>& tools, FieldErrors& errors) {
  Job job;
  Operation& op = job.operation;
  job.setup = FromProto(request.setup(), "setup", errors);
  if (!tools.empty()) {
    op.tool = *std::min_element(tools.begin(), tools.end(),
                                [](const Tool& a, const Tool& b) { return BallRadius(a) < BallRadius(b); });
  }
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
  op.accept_depth = ReadAcceptDepth(request.accept_depth_mm(), "", errors);
  op.keep_feed = request.keep_feed_on_passes();
  if (op.keep_feed && !StockIsStated(job.setup))
    errors.Add("keep_feed_on_passes", "= true; needs the stock to be stated (setup.stock)");
  if (op.keep_feed && op.accept_depth > job.setup.allowance.Least())
    errors.Add("keep_feed_on_passes",
               "= true; must be false where accept_depth_mm is more than the allowance");
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
  if (request.has_machine_z_safe_mm()) {
    constexpr double kMost = limits::kMaxCoordinateMm;
    Require(errors, "machine_z_safe_mm", request.machine_z_safe_mm(),
            request.machine_z_safe_mm() >= -kMost && request.machine_z_safe_mm() <= 0.0,
            fmt::format("in [{}, 0]", -kMost));
  }
  job.work_offset.clear();  // a program that is only verified may use any
  return job;
}

struct VerifyAnswer {
  v1::Report report;
  std::string leftover_csv, leftover_png;
  std::vector<v1::MeshBlock> mesh;
  std::optional<ProgramMotion> motion;  // if its blocks are wanted
};

// What the answer has besides the report.
struct Wanted {
  bool mesh = false, path_blocks = false;
  std::optional<double> chord;  // mm, of the mesh
};

struct VerifyJob {
  std::vector<Tool> tools;
  Job job;  // of the smallest tool
  Wanted wanted;
};

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

// The program, and how it is read.
struct ProgramText {
  std::string_view text;
  ReaderParams params;
};

ProgramText TextOf(const v1::VerifyProgramRequest& request, const Job& job, const std::vector<Tool>& tools,
                   const RunContext& run) {
  constexpr double kMachineZSafe = -10.0;  // mm
  ProgramText program;
  program.text = request.program();
  program.params.run = &run;
  program.params.dialect = job.dialect;
  program.params.control_deviation = job.control_deviation;
  program.params.assume_exact_path = request.assume_exact_path();
  program.params.machine_z_safe = request.has_machine_z_safe_mm()
                                      ? request.machine_z_safe_mm()
                                      : std::min(kMachineZSafe, job.dialect.machine_top);
  program.params.several_tools = tools.size() > 1;
  for (const Tool& tool : tools) {
    if (!tool.name.empty()) program.params.tools_by_name[absl::AsciiStrToLower(tool.name)] = tool.number;
  }
  return program;
}

absl::StatusOr<ProgramMotion> Read(const ProgramText& program) {
  absl::StatusOr<ProgramMotion> motion = ReadProgram(program.text, program.params);
  if (motion.ok() || motion.status().code() != absl::StatusCode::kInvalidArgument) return motion;
  return ProgramUnreadableError("program: " + std::string(motion.status().message()));
}

// What all parts of the program are judged by.
struct Judging {
  const Surface& surface;
  const std::vector<Tool>& tools;
  const Job& job;            // of any of the tools
  const Resolved& resolved;  // of this job
  bool with_scallop = false, with_map = false;
  const RunContext& run;
};

// One tool's moves.
absl::StatusOr<VerifyReport> JudgeTool(const Judging& by, const Tool& tool, const ProgramMotion& motion) {
  Job job = by.job;
  job.operation.tool = tool;
  PM_ASSIGN_OR_RETURN(const Resolved resolved, Resolve(by.surface, job, by.resolved.stock, by.run));
  PM_ASSIGN_OR_RETURN(const std::vector<PlanPart> parts, VerifiedParts(by.surface, job, resolved, by.run));
  VerifyParams params = MakeVerifyParams(job, resolved, parts);
  params.sample_leftover = by.with_map;
  if (!by.with_scallop) {
    params.finish.scallop.reset();
    for (FinishPart& part : params.parts) part.finish.scallop.reset();
  }
  PM_ASSIGN_OR_RETURN(VerifyReport report, Verify(by.surface, tool, motion, params, by.run));
  PM_ASSIGN_OR_RETURN(const Diagnostics beside,
                      FindToolBesidePart(by.surface, TipsOf(motion, resolved.program_zero), resolved.radius,
                                         resolved.program_zero, by.run));
  report.findings.insert(report.findings.begin(), beside.begin(), beside.end());
  return report;
}

// The tool that a number of the program stands for. The first one is in the spindle before any tool change.
absl::StatusOr<const Tool*> ToolOf(const Judging& by, int number, const ProgramMotion& motion) {
  if (by.tools.size() == 1 || number < 0) return &by.tools.front();
  for (const Tool& tool : by.tools) {
    if (tool.number == number) return &tool;
  }
  const auto first = std::find_if(motion.moves.begin(), motion.moves.end(),
                                  [&](const ProgramMove& move) { return move.tool == number; });
  std::string numbers;
  for (const Tool& tool : by.tools) numbers += fmt::format("{}{}", numbers.empty() ? "" : ", ", tool.number);
  return ProgramUnreadableError(
      fmt::format("program: line {}: tool {} moves, but the tools are {}; state this one, too", first->line,
                  number, numbers));
}

absl::StatusOr<VerifyReport> JudgeMotion(const Judging& by, const ProgramMotion& motion) {
  const std::vector<int> numbers = ToolsOf(motion);
  if (by.tools.size() == 1 || numbers.size() < 2) {
    PM_ASSIGN_OR_RETURN(const Tool* tool, ToolOf(by, numbers.empty() ? -1 : numbers.front(), motion));
    return JudgeTool(by, *tool, motion);
  }
  std::vector<PartReport> parts;
  for (const int number : numbers) {
    PM_ASSIGN_OR_RETURN(const Tool* tool, ToolOf(by, number, motion));
    const ProgramMotion own = MovesOfTool(motion, number);
    PM_ASSIGN_OR_RETURN(VerifyReport report, JudgeTool(by, *tool, own));
    if (number < 0) {
      report.findings.push_back(
          MakeWarning("TOOL_ASSUMED",
                      fmt::format("line {}: tool {} is taken to be in the spindle before the first M6",
                                  own.moves.front().line, tool->number),
                      {.line = own.moves.front().line}));
    }
    parts.push_back(
        {number < 0 ? "the tool before the first M6" : fmt::format("tool {}", number), std::move(report)});
  }
  return JoinReports(std::move(parts), PartsOfProgram::kTools);
}

// Both ways of running lines with /, if there are any.
absl::StatusOr<VerifyReport> JudgeWays(const Judging& by, const ProgramMotion& motion, ProgramText program) {
  PM_ASSIGN_OR_RETURN(VerifyReport run, JudgeMotion(by, motion));
  if (!motion.has_deletable_lines) return run;
  program.params.run_deletable_lines = false;
  PM_ASSIGN_OR_RETURN(const ProgramMotion without, Read(program));
  PM_ASSIGN_OR_RETURN(VerifyReport skipped, JudgeMotion(by, without));
  std::vector<PartReport> ways;
  ways.push_back({"with the lines of / run", std::move(run)});
  ways.push_back({"with the lines of / skipped", std::move(skipped)});
  VerifyReport joined = JoinReports(std::move(ways), PartsOfProgram::kWays);
  joined.findings.push_back(
      MakeInfo("DELETABLE_LINES",
               "lines with / are judged all run and all skipped; switching between them is not judged"));
  return joined;
}

void FillFromMotion(const ProgramMotion& motion, v1::Report* report) {
  report->mutable_setup_sheet()->set_tool_number(motion.tool_number);
  report->mutable_setup_sheet()->clear_clearance_z_mm();
  report->set_point_count(static_cast<int>(motion.moves.size()));
  report->set_retract_count(RetractCount(motion));
  if (std::isfinite(motion.controller_tolerance))
    report->set_controller_tolerance_mm(motion.controller_tolerance);
  report->set_time_basis("not estimated");
}

// A tool, and its own moves.
struct ToolMotion {
  const Tool* tool = nullptr;
  ProgramMotion moves;
};
absl::StatusOr<std::vector<ToolMotion>> MovesByTool(const Judging& by, const ProgramMotion& motion) {
  const std::vector<int> numbers = ToolsOf(motion);
  std::vector<ToolMotion> moves;
  if (by.tools.size() == 1 || numbers.size() < 2) {
    PM_ASSIGN_OR_RETURN(const Tool* tool, ToolOf(by, numbers.empty() ? -1 : numbers.front(), motion));
    moves.push_back({tool, motion});
    return moves;
  }
  for (const int number : numbers) {
    PM_ASSIGN_OR_RETURN(const Tool* tool, ToolOf(by, number, motion));
    moves.push_back({tool, MovesOfTool(motion, number)});
  }
  return moves;
}

// The triangles, with what the program leaves whether its lines with / run or not.
absl::Status MakeMesh(const Judging& by, const Wanted& wanted, const ProgramMotion& motion,
                      ProgramText program, VerifyAnswer* answer) {
  const Vec3& zero = by.resolved.program_zero;
  std::vector<std::vector<ToolMotion>> ways(1);
  PM_ASSIGN_OR_RETURN(ways.front(), MovesByTool(by, motion));
  if (motion.has_deletable_lines) {
    program.params.run_deletable_lines = false;
    PM_ASSIGN_OR_RETURN(const ProgramMotion without, Read(program));
    PM_ASSIGN_OR_RETURN(std::vector<ToolMotion> skipped, MovesByTool(by, without));
    ways.push_back(std::move(skipped));
  }
  DrawingParams params;
  params.chord = wanted.chord;
  for (const std::vector<ToolMotion>& way : ways) {
    std::vector<BallMotion>& balls = params.ways.emplace_back();
    for (const ToolMotion& one : way)
      balls.push_back({&one.moves, zero, BallRadius(*one.tool), by.job.operation.leave});
  }
  PM_ASSIGN_OR_RETURN(const SurfaceDrawing drawing, DrawSurface(by.surface, params, by.run));
  EmitMesh(drawing, by.surface, zero, [&](v1::MeshBlock block) {
    answer->mesh.push_back(std::move(block));
    return !by.run.Cancelled();
  });
  return absl::OkStatus();
}

absl::Status Make(const Call& call, const v1::VerifyProgramRequest& request, const VerifyJob& what,
                  const RunContext& run, VerifyAnswer* answer) {
  v1::Report* report = &answer->report;
  Job job = what.job;
  run.Progress("model", 0.0);
  PM_ASSIGN_OR_RETURN(LoadedModel model, LoadModel(request.source(), "source", run, ModelsOf(call)));
  PM_RETURN_IF_ERROR(RequireSound(model));
  PM_RETURN_IF_ERROR(run.Check());
  const ProgramText program = TextOf(request, job, what.tools, run);
  PM_ASSIGN_OR_RETURN(ProgramMotion motion, Read(program));
  PM_RETURN_IF_ERROR(run.Check());
  PM_ASSIGN_OR_RETURN(UprightModel upright, MakeUpright(std::move(model), job.setup, run));
  job.setup = std::move(upright.setup);
  PM_RETURN_IF_ERROR(LoadStock(request.setup().stock(), "setup.stock", job.setup, run, ModelsOf(call)));
  PM_ASSIGN_OR_RETURN(
      const std::shared_ptr<const Surface> built,
      PlacedSurface(std::move(upright.model.model), upright.model.digest, job.setup, run, ModelsOf(call)));
  const Surface& surface = *built;
  PM_ASSIGN_OR_RETURN(const Resolved resolved, Resolve(surface, job, run));
  if (what.wanted.mesh && what.wanted.chord) PM_RETURN_IF_ERROR(CheckChord(surface, *what.wanted.chord, run));
  const Judging by{surface, what.tools, job, resolved, request.has_scallop_mm(), request.leftover_map(), run};
  PM_ASSIGN_OR_RETURN(const VerifyReport verify, JudgeWays(by, motion, program));
  FillFromVerifier(verify, resolved.program_zero, request.has_scallop_mm(), report);
  report->set_outcome(Judge(*report, verify.NothingToFinish()));
  *report->mutable_setup_sheet() = ToProto(resolved, job);
  FillFromMotion(motion, report);
  if (!request.has_scallop_mm()) {
    AddDiagnostics(
        {MakeWarning("FINISH_NOT_CHECKED",
                     "no scallop is given: the finish is not checked, nor whether the program cuts anything",
                     {.field = "scallop_mm"})},
        resolved.program_zero, report->mutable_diagnostics());
  }
  AddDiagnostics(HeaderRemarks(upright.model.remarks), resolved.program_zero, report->mutable_diagnostics());
  AddDiagnostics(WallsWithoutSide(surface), resolved.program_zero, report->mutable_diagnostics());
  AddDiagnostics(verify.findings, resolved.program_zero, report->mutable_diagnostics());
  if (what.wanted.mesh) PM_RETURN_IF_ERROR(MakeMesh(by, what.wanted, motion, program, answer));
  if (what.wanted.path_blocks) answer->motion = std::move(motion);
  if (!request.leftover_map()) return absl::OkStatus();
  constexpr double kLimit = 0.1;  // mm, of the colours where no scallop is given
  const double limit = request.has_scallop_mm() ? request.scallop_mm() + request.tolerance_mm() : kLimit;
  answer->leftover_csv = LeftoverCsv(verify.leftover_map, resolved.program_zero);
  answer->leftover_png = LeftoverPng(verify.leftover_map, limit);
  return absl::OkStatus();
}

bool SendPathBlocks(const ProgramMotion& motion, const Sink<Response>& sink) {
  return EmitPathBlocks(motion, [&](v1::PathBlock block) {
    Response response;
    *response.mutable_path_block() = std::move(block);
    return sink(response);
  });
}

bool SendFile(const char* name, const char* media_type, std::string_view bytes, const Sink<Response>& sink) {
  for (std::size_t at = 0; at < bytes.size(); at += limits::kChunkBytes) {
    Response response;
    v1::ArtifactChunk& chunk = *response.mutable_artifact();
    chunk.set_name(name);
    chunk.set_media_type(media_type);
    chunk.set_offset_bytes(static_cast<std::int64_t>(at));
    chunk.set_data(std::string(bytes.substr(at, limits::kChunkBytes)));
    if (!sink(response)) return false;
  }
  return true;
}

bool SendAnswer(VerifyAnswer& answer, const Sink<Response>& sink) {
  if (answer.motion && !SendPathBlocks(*answer.motion, sink)) return false;
  for (v1::MeshBlock& block : answer.mesh) {
    Response response;
    *response.mutable_mesh() = std::move(block);
    if (!sink(response)) return false;
  }
  if (!SendFile("leftover.csv", "text/csv", answer.leftover_csv, sink)) return false;
  if (!SendFile("leftover.png", "image/png", answer.leftover_png, sink)) return false;
  Response last;
  *last.mutable_report() = std::move(answer.report);
  return sink(last);
}

// The allowance may stand on the surface beside the holder.
void CheckHolderClearance(const v1::VerifyProgramRequest& request, double allowance, std::vector<Tool>& tools,
                          FieldErrors& errors) {
  for (int k = 0; k < static_cast<int>(tools.size()); ++k) {
    Tool& tool = tools[static_cast<std::size_t>(k)];
    if (tool.holder.empty()) continue;
    if (!request.tools(k).has_holder_clearance_mm())
      tool.holder_clearance = std::max(tool.holder_clearance, allowance);
    if (tool.holder_clearance < allowance) {
      errors.Add(fmt::format("tools[{}].holder_clearance_mm", k),
                 fmt::format("= {:.10g}; must be at least the stock allowance, {:.10g}",
                             tool.holder_clearance, allowance));
    }
  }
}

}  // namespace

absl::Status HandleVerifyProgram(const Call& call, const v1::VerifyProgramRequest& request,
                                 const Sink<Response>& sink) {
  PM_RETURN_IF_ERROR(RefuseUnknownFields(request));
  PM_RETURN_IF_ERROR(CheckThreads(request.max_threads(), "max_threads"));
  FieldErrors errors;
  VerifyJob what;
  what.tools = ReadTools(request, errors);
  what.job = ReadJob(request, what.tools, errors);
  CheckHolderClearance(request, what.job.setup.allowance.Most(), what.tools, errors);
  if (request.has_tessellation_chord_mm())
    what.wanted.chord = ReadChord(request.tessellation_chord_mm(), errors);
  PM_RETURN_IF_ERROR(errors.ToStatus());
  PM_ASSIGN_OR_RETURN(const Outputs outputs,
                      ReadOutputs(request.outputs(), {v1::OUTPUT_TESSELLATION, v1::OUTPUT_PATH_BLOCKS}, {}));
  what.wanted.mesh = outputs.contains(v1::OUTPUT_TESSELLATION);
  what.wanted.path_blocks = outputs.contains(v1::OUTPUT_PATH_BLOCKS);
  Work work{.max_threads = request.max_threads()};
  work.beat = [&](const v1::Progress& progress) {
    Response response;
    *response.mutable_progress() = progress;
    return sink(response);
  };
  return RunJobCall(call, work, [&](const RunContext& run) -> absl::Status {
    VerifyAnswer answer;
    PM_RETURN_IF_ERROR(Make(call, request, what, run, &answer));
    return SendAnswer(answer, sink) ? absl::OkStatus() : absl::CancelledError("the client has gone");
  });
}

}  // namespace patchmill
