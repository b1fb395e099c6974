#include <utility>

#include <fmt/format.h>

#include "cam/plan/plan.h"
#include "core/base/status.h"
#include "core/exchange/iges.h"
#include "core/exchange/mesh_files.h"
#include "core/exchange/step.h"
#include "core/io/text_scanner.h"
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

constexpr double kLeastChord = 1e-4, kMostChord = 10.0, kDefaultChord = 0.01;  // mm

bool IsMesh(const std::string& format) { return format == "stl" || format == "obj"; }

void CheckFile(const v1::ConvertModelRequest& request, FieldErrors& errors) {
  const std::string& format = request.file_format();
  if (!format.empty() && format != "iges" && format != "step" && !IsMesh(format)) {
    errors.Add("file_format", fmt::format("= {}; must be one of iges, step, stl, obj", Quoted(format)));
  }
  if (!request.has_chord_mm()) return;
  if (!IsMesh(format))
    errors.Add("chord_mm", "is set; it belongs to the formats stl and obj, which have triangles");
  Require(errors, "chord_mm", request.chord_mm(),
          request.chord_mm() >= kLeastChord && request.chord_mm() <= kMostChord,
          fmt::format("in [{:g}, {:g}]", kLeastChord, kMostChord));
}

struct ModelFile {
  std::string bytes;
  std::size_t items = 0;
  Diagnostics findings;
};

absl::StatusOr<ModelFile> FileOf(const v1::ConvertModelRequest& request, PatchModel model,
                                 const RunContext& run) {
  ModelFile file;
  const std::string& format = request.file_format();
  if (IsMesh(format)) {
    PM_ASSIGN_OR_RETURN(const Surface surface, BuildPlacedSurface(std::move(model), Setup(), run));
    const double chord = request.has_chord_mm() ? request.chord_mm() : kDefaultChord;
    PM_ASSIGN_OR_RETURN(const std::vector<PieceTriangles> mesh,
                        MakeSurfaceMesh(surface, {.chord = chord}, run));
    for (const PieceTriangles& piece : mesh) file.items += piece.triangles.size();
    file.bytes = format == "stl" ? StlBytes(mesh) : ObjText(mesh);
  } else {
    PM_ASSIGN_OR_RETURN(SplineSurfaces surfaces, SplineSurfacesOf(model, run));
    file.items = surfaces.surfaces.size();
    file.bytes = format == "step" ? StepText(surfaces) : IgesText(surfaces);
    file.findings = std::move(surfaces.findings);
  }
  if (file.bytes.size() > limits::kMaxMessageBytes - (std::size_t{1} << 20)) {
    return LimitError("file_bytes", static_cast<double>(limits::kMaxMessageBytes),
                      static_cast<double>(file.bytes.size()));
  }
  return file;
}

}  // namespace

absl::Status HandleConvertModel(const Call& call, const v1::ConvertModelRequest& request,
                                v1::ConvertModelResponse* response) {
  PM_RETURN_IF_ERROR(RefuseUnknownFields(request));
  PM_RETURN_IF_ERROR(CheckThreads(request.max_threads(), "max_threads"));
  Placement placement;
  FieldErrors errors;
  CheckFile(request, errors);
  if (request.has_scale()) {
    placement.scale = request.scale();
    Require(errors, "scale", request.scale(),
            request.scale() >= limits::kMinScale && request.scale() <= limits::kMaxScale,
            fmt::format("in [{:g}, {:g}]", limits::kMinScale, limits::kMaxScale));
  }
  PM_RETURN_IF_ERROR(errors.ToStatus());
  return RunQuickCall(
      call, {.max_threads = request.max_threads()}, [&](const RunContext& run) -> absl::Status {
        const ModelAccess models = ModelsOf(call);
        PM_ASSIGN_OR_RETURN(LoadedModel loaded, LoadModel(request.source(), "source", run, models));
        AddDiagnostics(loaded.faults, Vec3::Zero(), response->mutable_diagnostics());
        if (!loaded.faults.empty()) return absl::OkStatus();
        PM_RETURN_IF_ERROR(run.Check());
        const bool as_file = !request.file_format().empty();
        if (loaded.network && !as_file) {
          PM_RETURN_IF_ERROR(CopyNetwork(request, models, run, response->mutable_model()));
          response->set_model_sha256(loaded.digest);
          AddDiagnostics(loaded.remarks, Vec3::Zero(), response->mutable_diagnostics());
          return absl::OkStatus();
        }
        PatchModel model = Place(placement, std::move(loaded.model));
        response->set_model_sha256(ModelDigest(model));
        if (!as_file) {
          *response->mutable_model() = ToProto(model);
          AddDiagnostics(loaded.remarks, Vec3::Zero(), response->mutable_model()->mutable_findings());
        }
        if (loaded.unitless) loaded.remarks.push_back(UnitFinding(ControlBox(model), std::nullopt));
        AddDiagnostics(loaded.remarks, Vec3::Zero(), response->mutable_diagnostics());
        if (as_file) {
          PM_ASSIGN_OR_RETURN(ModelFile file, FileOf(request, std::move(model), run));
          AddDiagnostics(file.findings, Vec3::Zero(), response->mutable_diagnostics());
          *response->mutable_file() = std::move(file.bytes);
          response->set_file_item_count(static_cast<int>(file.items));
        }
        return run.Check();
      });
}

}  // namespace patchmill
