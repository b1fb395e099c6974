#include <utility>

#include <fmt/format.h>

#include "cam/plan/plan.h"
#include "core/base/status.h"
#include "core/editing/surface_normals.h"
#include "core/joining/join_network.h"
#include "server/convert/editing.h"
#include "server/convert/first_surface.h"
#include "server/convert/model.h"
#include "server/convert/network.h"
#include "server/convert/report.h"
#include "server/handlers/handlers.h"
#include "server/handlers/prepare.h"

namespace patchmill {
namespace {

absl::Status TakeNormals(const v1::BuildModelRequest& request, double unit, PatchModel model,
                         const RunContext& run, v1::BuildModelResponse* response) {
  const auto findings = [response](const Diagnostics& list) {
    AddDiagnostics(list, Vec3::Zero(), response->mutable_diagnostics());
  };
  Diagnostics faults;
  const CurveNetwork before = FromProto(request.network(), unit, faults);
  if (!faults.empty()) {
    findings(faults);
    return absl::OkStatus();
  }
  PM_ASSIGN_OR_RETURN(const Surface surface, BuildPlacedSurface(std::move(model), Setup(), run));
  PM_ASSIGN_OR_RETURN(const NetworkOnSurface made, WithNormalsOf(surface, before, run));
  v1::PatchModel& to = *response->mutable_network_model();
  to.set_length_unit(request.length_unit());
  *to.mutable_network() = request.network();
  WriteEdited(before, made.network, unit, to.mutable_network());
  response->set_max_distance_mm(made.max_distance);
  response->set_farthest_vertex(made.farthest_vertex);
  PM_ASSIGN_OR_RETURN(const JoinedNetwork joined, JoinNetwork(made.network, run));
  findings(joined.findings);
  return absl::OkStatus();
}

}  // namespace

absl::Status HandleBuildModel(const Call& call, const v1::BuildModelRequest& request,
                              v1::BuildModelResponse* response) {
  PM_RETURN_IF_ERROR(RefuseUnknownFields(request));
  PM_RETURN_IF_ERROR(CheckThreads(request.max_threads(), "max_threads"));
  const std::optional<double> unit = MillimetersPer(request.length_unit());
  if (!unit) {
    FieldErrors errors;
    errors.Add("length_unit", UnitFault(request.length_unit()));
    return errors.ToStatus();
  }
  PM_RETURN_IF_ERROR(CheckNetworkLimits(request.network()));
  return RunQuickCall(
      call, {.max_threads = request.max_threads()}, [&](const RunContext& run) -> absl::Status {
        PatchModel model;
        PM_ASSIGN_OR_RETURN(PatchShape shape, OutlineSurface(request, *unit));
        model.patches.push_back({"outline", std::move(shape)});
        if (const Diagnostics faults = ValidateModel(model); !faults.empty()) {
          AddDiagnostics(faults, Vec3::Zero(), response->mutable_diagnostics());
          return absl::OkStatus();
        }
        *response->mutable_model() = ToProto(model);
        PM_RETURN_IF_ERROR(run.Check());
        return request.has_network() ? TakeNormals(request, *unit, std::move(model), run, response)
                                     : absl::OkStatus();
      });
}

}  // namespace patchmill
