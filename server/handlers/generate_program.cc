#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "cam/plan/drawing.h"
#include "cam/plan/job_preview.h"
#include "cam/plan/plan.h"
#include "cam/plan/resolve.h"
#include "cam/post/program_reader.h"
#include "core/base/status.h"
#include "server/convert/drawing.h"
#include "server/convert/job.h"
#include "server/convert/paths.h"
#include "server/convert/report.h"
#include "server/estimate_memory.h"
#include "server/handlers/handlers.h"
#include "server/handlers/outputs.h"
#include "server/handlers/prepare.h"
#include "server/limits.h"
#include "server/placed_surface.h"

namespace patchmill {
namespace {

using Response = v1::GenerateProgramResponse;

const Outputs kPossible = {v1::OUTPUT_PROGRESS, v1::OUTPUT_REGIONS,     v1::OUTPUT_PATHS,
                           v1::OUTPUT_PROGRAM,  v1::OUTPUT_REPORT,      v1::OUTPUT_PICTURE,
                           v1::OUTPUT_ARCS,     v1::OUTPUT_PATH_BLOCKS, v1::OUTPUT_TESSELLATION};
const Outputs kDefaults = {v1::OUTPUT_PROGRESS, v1::OUTPUT_PROGRAM, v1::OUTPUT_REPORT};

Response MakeAccepted(const PreparedJob& prepared, const Outputs& outputs, std::int64_t memory_bytes) {
  Response response;
  v1::Accepted& accepted = *response.mutable_accepted();
  accepted.set_request_sha256(prepared.digest);
  accepted.set_server_version(ServerVersion());
  accepted.set_memory_estimate_bytes(memory_bytes);
  *accepted.mutable_resolved_job() = ToProto(prepared.job, prepared.model.digest, prepared.name);
  *accepted.mutable_resolved_post() = PostToProto(prepared.job);
  if (outputs.contains(v1::OUTPUT_REGIONS) || outputs.contains(v1::OUTPUT_PATHS) ||
      outputs.contains(v1::OUTPUT_ARCS) || outputs.contains(v1::OUTPUT_PATH_BLOCKS) ||
      outputs.contains(v1::OUTPUT_TESSELLATION)) {
    *accepted.mutable_patch_ids() = PatchIds(prepared.model.model);
  }
  return response;
}

// Bytes that the job will take, as far as its model shows.
std::int64_t EstimatedMemory(const PreparedJob& prepared, const ServerEnv& env) {
  const double bytes =
      static_cast<double>(EstimateMemory(prepared.model.model, prepared.job)) * env.options.estimate_factor;
  return static_cast<std::int64_t>(bytes);
}

// The results of the worker thread that the answer needs.
struct Made {
  Resolved resolved;
  JobResult result;
  std::string picture;
  std::vector<v1::MeshBlock> mesh;
  std::vector<std::string> face_ids;  // as FaceIds gives them
};

// What the worker thread makes besides the program.
struct Wanted {
  bool picture = false, mesh = false;
  std::optional<double> chord;  // mm, of the mesh
};

// The triangles, and what the program leaves at their corners, as its text says.
absl::Status MakeMesh(const Surface& surface, const Job& job, const Wanted& wanted, const RunContext& run,
                      Made* made) {
  const JobResult& result = made->result;
  DrawingParams params;
  params.chord = wanted.chord;
  params.map = &result.regions;
  std::optional<ProgramMotion> motion;
  if (!result.program.empty()) {
    PM_ASSIGN_OR_RETURN(motion, ReadProgram(result.program, {.max_moves = MostMovesOf(result.motion),
                                                             .run = &run,
                                                             .dialect = job.dialect,
                                                             .control_deviation = job.control_deviation}));
  }
  if (motion)
    params.ways = {{BallMotion{&*motion, result.program_zero, made->resolved.radius, job.operation.leave}}};
  PM_ASSIGN_OR_RETURN(const SurfaceDrawing drawing, DrawSurface(surface, params, run));
  EmitMesh(drawing, surface, result.program_zero, [&](v1::MeshBlock block) {
    made->mesh.push_back(std::move(block));
    return !run.Cancelled();
  });
  return absl::OkStatus();
}

// Moves the model out of `prepared`; nothing else needs it.
absl::Status Make(PreparedJob& prepared, const Wanted& wanted, const ModelAccess& models,
                  const RunContext& run, Made* made) {
  PM_ASSIGN_OR_RETURN(
      const std::shared_ptr<const Surface> built,
      PlacedSurface(std::move(prepared.model.model), prepared.model.digest, prepared.job.setup, run, models));
  const Surface& surface = *built;
  made->face_ids = FaceIds(surface.network.model);
  PM_ASSIGN_OR_RETURN(made->resolved, Resolve(surface, prepared.job, run));
  if (wanted.mesh && wanted.chord) PM_RETURN_IF_ERROR(CheckChord(surface, *wanted.chord, run));
  PM_ASSIGN_OR_RETURN(made->result, RunJob(surface, prepared.job, made->resolved, run));
  if (made->result.program.size() > limits::kMaxProgramBytes) {
    return LimitError("program_size_bytes", static_cast<double>(limits::kMaxProgramBytes),
                      static_cast<double>(made->result.program.size()));
  }
  if (wanted.mesh) PM_RETURN_IF_ERROR(MakeMesh(surface, prepared.job, wanted, run, made));
  if (wanted.picture) made->picture = DrawJob(surface, made->result, made->resolved, prepared.name);
  return absl::OkStatus();
}

// Checks everything that can be checked without planning.
absl::Status Validate(const PreparedJob& prepared, const ModelAccess& models, const RunContext& run) {
  PM_ASSIGN_OR_RETURN(
      const std::shared_ptr<const Surface> surface,
      PlacedSurface(prepared.model.model, prepared.model.digest, prepared.job.setup, run, models));
  PM_RETURN_IF_ERROR(ValidateJob(prepared.job));
  return Resolve(*surface, prepared.job, run).status();
}

// Calls send(offset, piece) for pieces of at most limits::kChunkBytes.
bool InChunks(std::string_view bytes, const std::function<bool(std::size_t, std::string_view)>& send) {
  for (std::size_t at = 0; at < bytes.size(); at += limits::kChunkBytes) {
    if (!send(at, bytes.substr(at, limits::kChunkBytes))) return false;
  }
  return true;
}

bool SendPaths(const Toolpath& toolpath, const Vec3& zero, const Sink<Response>& sink) {
  return EmitPaths(toolpath, zero, [&](PathEvent event) {
    Response response;
    if (auto* arc = std::get_if<v1::ArcMove>(&event)) {
      *response.mutable_arc() = std::move(*arc);
    } else {
      *response.mutable_paths() = std::move(std::get<v1::PathChunk>(event));
    }
    return sink(response);
  });
}

bool SendPathBlocks(const JobResult& result, const Sink<Response>& sink) {
  return EmitPathBlocks(result, [&](v1::PathBlock block) {
    Response response;
    *response.mutable_path_block() = std::move(block);
    return sink(response);
  });
}

bool SendPicture(std::string_view picture, const Sink<Response>& sink) {
  return InChunks(picture, [&](std::size_t at, std::string_view piece) {
    Response response;
    v1::ArtifactChunk& chunk = *response.mutable_artifact();
    chunk.set_name("preview.svg");
    chunk.set_media_type("image/svg+xml");
    chunk.set_offset_bytes(static_cast<std::int64_t>(at));
    chunk.set_data(std::string(piece));
    return sink(response);
  });
}

bool SendProgram(std::string_view program, const Sink<Response>& sink) {
  return InChunks(program, [&](std::size_t at, std::string_view piece) {
    Response response;
    response.mutable_program()->set_offset_bytes(static_cast<std::int64_t>(at));
    response.mutable_program()->set_data(std::string(piece));
    return sink(response);
  });
}

// Sends regions, paths, triangles, artifacts, program and report, in this order. A job that failed has no
// paths and no program.
bool SendResult(const PreparedJob& prepared, Made& made, const Outputs& outputs, const Sink<Response>& sink) {
  const JobResult& result = made.result;
  const bool verified = !result.program.empty();
  Response last;
  v1::Report& report = *last.mutable_report();
  report = ToProto(result.report, prepared.job, made.resolved, result.program);
  if (outputs.contains(v1::OUTPUT_REGIONS)) {
    Response response;
    *response.mutable_regions() = ToProto(result.regions, result.report.choices, result.report.figures,
                                          made.resolved.program_zero, made.face_ids);
    for (int id = 0; id < report.regions_size(); ++id) {
      response.mutable_regions()->mutable_regions(id)->set_deepest_leftover_mm(
          report.regions(id).deepest_leftover_mm());
    }
    if (!sink(response)) return false;
  }
  const bool arcs = outputs.contains(v1::OUTPUT_ARCS);
  if ((arcs || outputs.contains(v1::OUTPUT_PATHS)) && verified &&
      !SendPaths(arcs ? result.posted : result.motion.toolpath, result.program_zero, sink))
    return false;
  if (outputs.contains(v1::OUTPUT_PATH_BLOCKS) && verified && !SendPathBlocks(result, sink)) return false;
  for (v1::MeshBlock& block : made.mesh) {
    Response response;
    *response.mutable_mesh() = std::move(block);
    if (!sink(response)) return false;
  }
  if (!SendPicture(made.picture, sink)) return false;
  if (outputs.contains(v1::OUTPUT_PROGRAM) && !SendProgram(result.program, sink)) return false;
  return sink(last);
}

}  // namespace

absl::Status HandleGenerateProgram(const Call& call, const v1::GenerateProgramRequest& request,
                                   const Sink<Response>& sink) {
  PM_RETURN_IF_ERROR(RefuseUnknownFields(request));
  PM_RETURN_IF_ERROR(CheckThreads(request.max_threads(), "max_threads"));
  PM_RETURN_IF_ERROR(CheckRequestId(request.request_id()));
  PM_ASSIGN_OR_RETURN(const Outputs outputs, ReadOutputs(request.outputs(), kPossible, kDefaults));
  Wanted wanted{outputs.contains(v1::OUTPUT_PICTURE), outputs.contains(v1::OUTPUT_TESSELLATION), {}};
  if (request.has_tessellation_chord_mm()) {
    FieldErrors errors;
    wanted.chord = ReadChord(request.tessellation_chord_mm(), errors);
    PM_RETURN_IF_ERROR(errors.ToStatus());
  }
  PreparedJob prepared;
  const auto prepare = [&](const RunContext& run) -> absl::Status {
    absl::StatusOr<PreparedJob> made = PrepareJob(request.job(), request.post(), run, ModelsOf(call));
    if (!made.ok()) return InJob(made.status());
    prepared = *std::move(made);
    PM_RETURN_IF_ERROR(run.Check());
    return request.validate_only() ? InJob(Validate(prepared, ModelsOf(call), run)) : absl::OkStatus();
  };
  PM_RETURN_IF_ERROR(RunQuickCall(call, {.max_threads = request.max_threads()}, prepare));
  const std::int64_t memory = EstimatedMemory(prepared, *call.env);
  const auto gone = [] { return absl::CancelledError("the client has gone"); };
  if (!sink(MakeAccepted(prepared, outputs, memory))) return gone();
  if (request.validate_only()) return absl::OkStatus();

  Work work{.max_threads = request.max_threads(), .memory_bytes = memory};
  if (outputs.contains(v1::OUTPUT_PROGRESS)) {
    work.beat = [&](const v1::Progress& progress) {
      Response response;
      *response.mutable_progress() = progress;
      return sink(response);
    };
  }
  // The answer is sent before the job's place and memory are given back: it takes as much memory as the job.
  return RunJobCall(call, work, [&](const RunContext& run) -> absl::Status {
    Made made;
    PM_RETURN_IF_ERROR(InJob(Make(prepared, wanted, ModelsOf(call), run, &made)));
    for (const StageTime& stage : made.result.report.stages)
      call.env->metrics.StageTook(stage.name, stage.seconds);
    call.env->metrics.FoundCertificateDefects(made.result.report.certificate_defects);
    return SendResult(prepared, made, outputs, sink) ? absl::OkStatus() : gone();
  });
}

}  // namespace patchmill
