#include <optional>
#include <utility>

#include <fmt/format.h>

#include "cam/plan/drawing.h"
#include "cam/plan/job_preview.h"
#include "cam/plan/plan.h"
#include "cam/plan/resolve.h"
#include "cam/plan/unused_settings.h"
#include "core/base/status.h"
#include "server/convert/drawing.h"
#include "server/convert/report.h"
#include "server/handlers/handlers.h"
#include "server/handlers/outputs.h"
#include "server/handlers/prepare.h"
#include "server/placed_surface.h"

namespace patchmill {

absl::Status HandleSplitRegions(const Call& call, const v1::SplitRegionsRequest& request,
                                v1::SplitRegionsResponse* response) {
  PM_RETURN_IF_ERROR(RefuseUnknownFields(request));
  PM_RETURN_IF_ERROR(CheckThreads(request.max_threads(), "max_threads"));
  PM_ASSIGN_OR_RETURN(
      const Outputs outputs,
      ReadOutputs(request.outputs(), {v1::OUTPUT_REGIONS, v1::OUTPUT_PICTURE, v1::OUTPUT_TESSELLATION},
                  {v1::OUTPUT_REGIONS}));
  std::optional<double> chord;
  if (request.has_tessellation_chord_mm()) {
    FieldErrors errors;
    chord = ReadChord(request.tessellation_chord_mm(), errors);
    PM_RETURN_IF_ERROR(errors.ToStatus());
  }
  const auto make = [&](const RunContext& run) -> absl::Status {
    PM_ASSIGN_OR_RETURN(PreparedJob prepared, PrepareJob(request.job(), v1::Post(), run, ModelsOf(call)));
    PM_RETURN_IF_ERROR(run.Check());
    const Job& job = prepared.job;
    PM_ASSIGN_OR_RETURN(const std::shared_ptr<const Surface> built,
                        PlacedSurface(std::move(prepared.model.model), prepared.model.digest, job.setup, run,
                                      ModelsOf(call)));
    const Surface& surface = *built;
    PM_ASSIGN_OR_RETURN(const Resolved resolved, Resolve(surface, job, run));
    if (chord) PM_RETURN_IF_ERROR(CheckChord(surface, *chord, run));
    PM_ASSIGN_OR_RETURN(const ChosenRegions regions, PlanRegions(surface, job, run));
    AddDiagnostics(UnusedSettings(job.operation), resolved.program_zero, response->mutable_diagnostics());
    AddDiagnostics(job.model_remarks, resolved.program_zero, response->mutable_diagnostics());
    AddDiagnostics(surface.network.findings, resolved.program_zero, response->mutable_diagnostics());
    if (outputs.contains(v1::OUTPUT_REGIONS)) {
      *response->mutable_regions() = ToProto(regions.map, regions.chosen.choices, regions.figures,
                                             resolved.program_zero, FaceIds(surface.network.model));
      *response->mutable_patch_ids() = PatchIds(surface.network.model);
    }
    if (outputs.contains(v1::OUTPUT_PICTURE)) {
      v1::ArtifactChunk& picture = *response->mutable_picture();
      picture.set_name("regions.svg");
      picture.set_media_type("image/svg+xml");
      picture.set_data(DrawRegions(surface, regions, resolved, job.operation.steep_angle, prepared.name));
    }
    if (outputs.contains(v1::OUTPUT_TESSELLATION)) {
      const DrawingParams params{.chord = chord, .map = &regions.map, .ways = {}};
      PM_ASSIGN_OR_RETURN(const SurfaceDrawing drawing, DrawSurface(surface, params, run));
      EmitMesh(drawing, surface, resolved.program_zero, [&](v1::MeshBlock block) {
        *response->add_mesh() = std::move(block);
        return !run.Cancelled();
      });
    }
    return absl::OkStatus();
  };
  return RunJobCall(call, {.max_threads = request.max_threads()},
                    [&](const RunContext& run) { return InJob(make(run)); });
}

}  // namespace patchmill
