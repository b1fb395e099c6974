#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "cam/limits/reach_tolerance.h"
#include "cam/plan/concave_faces.h"
#include "cam/plan/face_preview.h"
#include "cam/plan/plan.h"
#include "cam/plan/resolve.h"
#include "cam/plan/up_directions.h"
#include "core/base/status.h"
#include "core/joining/continuity.h"
#include "core/lines/patch_crossings.h"
#include "core/network/face_edges.h"
#include "core/surface/face_figures.h"
#include "core/surface/holes.h"
#include "server/convert/enums.h"
#include "server/convert/faces.h"
#include "server/convert/joints.h"
#include "server/convert/report.h"
#include "server/convert/setup.h"
#include "server/handlers/handlers.h"
#include "server/handlers/prepare.h"
#include "server/limits.h"

namespace patchmill {
namespace {

void FillNetwork(const PatchNetwork& network, v1::CheckModelResponse* response) {
  int joined = 0;
  double gap = 0.0, angle = 0.0;
  for (const EdgeLink& link : network.edges) {
    if (!link.neighbor || IsInsideFace(network.model, link)) continue;
    if (link.self < *link.neighbor) ++joined;
    gap = std::max(gap, link.gap);
    angle = std::max(angle, link.max_angle);
  }
  response->set_patch_count(static_cast<int>(network.model.patches.size()));
  response->set_face_count(static_cast<int>(network.model.faces.size()));
  response->set_convex_edge_length_mm(network.convex_length);
  response->set_concave_edge_length_mm(network.concave_length);
  response->set_open_edge_count(network.open_edge_count);
  response->set_joined_edge_count(joined);
  response->set_max_gap_mm(std::isfinite(gap) ? gap : 0.0);
  response->set_max_angle_deg(std::isfinite(angle) ? Degrees(angle) : 0.0);
  response->set_join_tolerance_mm(network.join_tolerance);
}

void FillFaces(const v1::CheckModelRequest& request, const Surface& surface,
               const std::vector<FaceFigures>& figures, const Vec3& zero, v1::CheckModelResponse* response) {
  const std::vector<ModelFace>& faces = surface.network.model.faces;
  for (std::size_t f = 0; request.with_faces() && f < faces.size(); ++f) {
    v1::FaceInfo& info = *response->add_faces();
    *info.mutable_face() = ToProto(faces[f]);
    info.set_patch_count(figures[f].patch_count);
    if (figures[f].patch_count == 0) continue;
    info.set_area_mm2(figures[f].area);
    info.set_min_tilt_deg(Degrees(figures[f].tilt_min));
    info.set_max_tilt_deg(Degrees(figures[f].tilt_max));
    *info.mutable_box() = ToProto(figures[f].box, zero);
  }
  if (!request.with_faces_picture()) return;
  v1::ArtifactChunk& picture = *response->mutable_picture();
  picture.set_name("faces.svg");
  picture.set_media_type("image/svg+xml");
  picture.set_data(DrawFaces(surface, figures, fmt::format("{} faces", faces.size())));
}

absl::Status FillFeatures(const v1::CheckModelRequest& request, const Surface& surface, const Vec3& zero,
                          const RunContext& run, v1::CheckModelResponse* response) {
  const PatchModel& model = surface.network.model;
  if (model.faces.empty()) return absl::OkStatus();
  PM_ASSIGN_OR_RETURN(const std::vector<FaceFigures> figures, MeasureFaces(surface, run));
  FillFaces(request, surface, figures, zero, response);
  PM_ASSIGN_OR_RETURN(const std::vector<ConcaveFaces> concave, GroupConcaveFaces(surface, figures, run));
  for (const ConcaveFaces& group : concave) *response->add_concave_faces() = ToProto(group, model);
  PM_ASSIGN_OR_RETURN(const std::vector<Hole> holes, FindHoles(surface, run));
  for (const Hole& hole : holes) *response->add_holes() = ToProto(hole, model, zero);
  return absl::OkStatus();
}

absl::Status FillUpDirections(const Surface& surface, const Placement& placement, const RunContext& run,
                              v1::CheckModelResponse* response) {
  PM_ASSIGN_OR_RETURN(const std::vector<UpDirection> directions,
                      MeasureUpDirections(surface, placement, run));
  for (const UpDirection& direction : directions) {
    v1::UpDirection& to = *response->add_up_directions();
    to.set_up(ToProto(direction.up));
    to.set_facing_area_mm2(direction.facing_area);
    to.set_hidden_area_mm2(direction.hidden_area);
    to.set_level_face_count(direction.level_face_count);
  }
  if (!directions.empty()) response->set_best_up(ToProto(BestUp(directions)));
  return absl::OkStatus();
}

}  // namespace

absl::Status HandleCheckModel(const Call& call, const v1::CheckModelRequest& request,
                              v1::CheckModelResponse* response) {
  PM_RETURN_IF_ERROR(RefuseUnknownFields(request));
  PM_RETURN_IF_ERROR(CheckThreads(request.max_threads(), "max_threads"));
  FieldErrors errors;
  const int steps = request.continuity_steps();
  if (steps < 0 || steps > limits::kMaxContinuitySteps) {
    errors.Add("continuity_steps",
               fmt::format("= {}; must be in [0, {}]", steps, limits::kMaxContinuitySteps));
  }
  Job job;
  job.setup = FromProto(request.setup(), "setup", errors);
  std::optional<Tool> tool;
  if (request.has_tool()) tool = FromProto(request.tool(), "tool", CuttingData::kOptional, errors);
  PM_RETURN_IF_ERROR(errors.ToStatus());
  if (tool) job.operation.tool = *tool;
  return RunQuickCall(
      call, {.max_threads = request.max_threads()}, [&](const RunContext& run) -> absl::Status {
        PM_ASSIGN_OR_RETURN(LoadedModel model, LoadModel(request.source(), "source", run, ModelsOf(call)));
        response->set_model_sha256(model.digest);
        if (!model.faults.empty()) {
          response->set_patch_count(static_cast<int>(model.model.patches.size()));
          AddDiagnostics(model.faults, Vec3::Zero(), response->mutable_diagnostics());
          return absl::OkStatus();
        }
        PM_RETURN_IF_ERROR(run.Check());
        PM_ASSIGN_OR_RETURN(UprightModel upright, MakeUpright(std::move(model), job.setup, run));
        model = std::move(upright.model);
        job.setup = std::move(upright.setup);
        PM_ASSIGN_OR_RETURN(PatchNetwork network, BuildPlacedNetwork(std::move(model.model), job.setup, run));
        ContinuityReport continuity;
        if (steps > 0) {
          PM_ASSIGN_OR_RETURN(continuity, MeasureContinuity(network, steps, run));
          const auto face_of = [&](const PatchEdge& edge) {
            return network.model.patches[edge.patch.index()].face;
          };
          std::erase_if(continuity.edges, [&](const EdgeContinuity& joint) {
            return face_of(joint.a) && face_of(joint.a) == face_of(joint.b);
          });
        }
        PM_ASSIGN_OR_RETURN(const Surface surface, BuildSurface(std::move(network), SurfaceParams{}, run));
        PM_ASSIGN_OR_RETURN(const Resolved resolved, Resolve(surface, job, run));
        PM_ASSIGN_OR_RETURN(ModelCheck check,
                            CheckModel(surface, tool, ReachTolerance(job.operation.tolerance), run));
        for (const Diagnostic& remark : Placed(model.remarks, job.setup.placement))
          check.findings.push_back(remark);
        if (model.unitless) {
          check.findings.push_back(UnitFinding(check.box, tool));
        } else if (std::optional<Diagnostic> huge = HugeModelFinding(check.box)) {
          check.findings.push_back(*std::move(huge));
        }
        if (request.with_crossings()) {
          PM_ASSIGN_OR_RETURN(const Crossings3d crossings, FindPatchCrossings(surface, {}, run));
          const Diagnostics crossing = CrossingFindings(surface, crossings);
          check.findings.insert(check.findings.end(), crossing.begin(), crossing.end());
        }
        AddDiagnostics(check.findings, resolved.program_zero, response->mutable_diagnostics());
        *response->mutable_box() = ToProto(check.box, resolved.program_zero);
        if (std::isfinite(check.min_concave_radius))
          response->set_min_concave_radius_mm(check.min_concave_radius);
        FillNetwork(surface.network, response);
        if (steps > 0) AddJoints(continuity, response->mutable_joints());
        PM_RETURN_IF_ERROR(FillUpDirections(surface, job.setup.placement, run, response));
        PM_RETURN_IF_ERROR(FillFeatures(request, surface, resolved.program_zero, run, response));
        return absl::OkStatus();
      });
}

}  // namespace patchmill
