#include <utility>

#include <fmt/format.h>

#include "core/base/status.h"
#include "server/convert/fields.h"
#include "server/convert/model.h"
#include "server/convert/report.h"
#include "server/digest.h"
#include "server/handlers/handlers.h"
#include "server/handlers/prepare.h"
#include "server/limits.h"

namespace patchmill {
namespace {

// A curve network stays one, so that it can still be edited.
absl::Status CopyNetwork(const v1::ConvertModelRequest& request, const ModelAccess& models,
                         const RunContext& run, v1::PatchModel* model) {
  if (request.has_scale() && request.scale() != 1.0) {
    FieldErrors errors;
    errors.Add("scale",
               fmt::format("= {:.10g}; must be 1 for a curve network, which keeps its scale; scale it "
                           "where it is milled",
                           request.scale()));
    return errors.ToStatus();
  }
  PM_ASSIGN_OR_RETURN(LoadedNetwork network, LoadNetwork(request.source(), "source", run, models));
  *model = std::move(network.message);
  return absl::OkStatus();
}

}  // namespace

absl::Status HandleConvertModel(const Call& call, const v1::ConvertModelRequest& request,
                                v1::ConvertModelResponse* response) {
  PM_RETURN_IF_ERROR(RefuseUnknownFields(request));
  PM_RETURN_IF_ERROR(CheckThreads(request.max_threads(), "max_threads"));
  Placement placement;
  if (request.has_scale()) {
    FieldErrors errors;
    placement.scale = request.scale();
    Require(errors, "scale", request.scale(),
            request.scale() >= limits::kMinScale && request.scale() <= limits::kMaxScale,
            fmt::format("in [{:g}, {:g}]", limits::kMinScale, limits::kMaxScale));
    PM_RETURN_IF_ERROR(errors.ToStatus());
  }
  return RunQuickCall(
      call, {.max_threads = request.max_threads()}, [&](const RunContext& run) -> absl::Status {
        const ModelAccess models = ModelsOf(call);
        PM_ASSIGN_OR_RETURN(LoadedModel loaded, LoadModel(request.source(), "source", run, models));
        AddDiagnostics(loaded.faults, Vec3::Zero(), response->mutable_diagnostics());
        if (!loaded.faults.empty()) return absl::OkStatus();
        PM_RETURN_IF_ERROR(run.Check());
        if (loaded.network) {
          PM_RETURN_IF_ERROR(CopyNetwork(request, models, run, response->mutable_model()));
          response->set_model_sha256(loaded.digest);
          AddDiagnostics(loaded.remarks, Vec3::Zero(), response->mutable_diagnostics());
          return absl::OkStatus();
        }
        const PatchModel model = Place(placement, std::move(loaded.model));
        *response->mutable_model() = ToProto(model);
        AddDiagnostics(loaded.remarks, Vec3::Zero(), response->mutable_model()->mutable_findings());
        response->set_model_sha256(ModelDigest(model));
        if (loaded.unitless) loaded.remarks.push_back(UnitFinding(ControlBox(model), std::nullopt));
        AddDiagnostics(loaded.remarks, Vec3::Zero(), response->mutable_diagnostics());
        return run.Check();
      });
}

}  // namespace patchmill
