#include "server/handlers/prepare.h"

#include <memory>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "cam/plan/choose_up.h"
#include "cam/plan/plan.h"
#include "core/base/status.h"
#include "core/surface/cap_holes.h"
#include "server/call.h"
#include "server/convert/fields.h"
#include "server/convert/job.h"
#include "server/digest.h"
#include "server/limits.h"
#include "server/unknown_fields.h"

namespace patchmill {

absl::Status RefuseUnknownFields(const google::protobuf::Message& request) {
  const std::string unknown = UnknownField(request);
  if (unknown.empty()) return absl::OkStatus();
  FieldErrors errors;
  errors.Add(unknown, fmt::format("is a field that server version {} does not know", ServerVersion()));
  return errors.ToStatus();
}

absl::Status RequireSound(const LoadedModel& model) {
  return model.faults.empty() ? absl::OkStatus() : ModelInvalidError(model.faults, model.path);
}

absl::StatusOr<UprightModel> MakeUpright(LoadedModel model, const Setup& setup, const RunContext& run) {
  PM_ASSIGN_OR_RETURN(ChosenUp chosen, ChooseUp(model.model, setup, run));
  for (Diagnostic& finding : chosen.findings) model.remarks.push_back(std::move(finding));
  if (chosen.setup.cap_holes) {
    const CapParams caps{*chosen.setup.cap_holes, chosen.setup.placement.scale};
    PM_ASSIGN_OR_RETURN(CappedModel capped, CapHoles(std::move(model.model), caps, run));
    model.model = std::move(capped.model);
    for (Diagnostic& finding : capped.findings) model.remarks.push_back(std::move(finding));
  }
  return UprightModel{std::move(model), std::move(chosen.setup)};
}

absl::Status LoadStock(const v1::Stock& stock, std::string_view at, Setup& setup, const RunContext& run,
                       const ModelAccess& models) {
  if (!std::holds_alternative<ModelStock>(setup.stock_body)) return absl::OkStatus();
  PM_ASSIGN_OR_RETURN(LoadedModel loaded, LoadModel(stock.model(), At(at, "model"), run, models));
  PM_RETURN_IF_ERROR(RequireSound(loaded));
  PM_RETURN_IF_ERROR(run.Check());
  Setup plain;
  plain.placement = setup.placement;
  std::string digest = loaded.digest;
  PM_ASSIGN_OR_RETURN(Surface surface, BuildPlacedSurface(std::move(loaded.model), plain, run));
  setup.stock_body = ModelStock{std::make_shared<const Surface>(std::move(surface)), std::move(digest)};
  return absl::OkStatus();
}

Diagnostics HeaderRemarks(const Diagnostics& remarks) {
  Diagnostics stated;
  for (const Diagnostic& remark : remarks) {
    if (remark.code == "UP_CHOSEN" || remark.code == "NOT_ALL_FACES" || remark.code == "HOLES_CAPPED")
      stated.push_back(remark);
  }
  return stated;
}

Diagnostics Placed(Diagnostics remarks, const Placement& placement) {
  for (Diagnostic& remark : remarks) {
    if (remark.where.point) remark.where.point = Place(placement, *remark.where.point);
  }
  return remarks;
}

Diagnostic UnitFinding(const Box3& box, const std::optional<Tool>& tool) {
  const double extent = (box.max - box.min).maxCoeff();
  const bool wrong = extent > 2000.0 || (tool && extent < 4.0 * BallRadius(*tool));
  std::string message =
      fmt::format("the file states no unit, millimetres are assumed: the model is {:.4g} mm large", extent);
  if (!wrong) return MakeInfo("UNIT_ASSUMED", std::move(message));
  return MakeWarning("SUSPICIOUS_SIZE", message + "; is the scale right?");
}

std::optional<Diagnostic> HugeModelFinding(const Box3& box) {
  constexpr double kHuge = 10000.0;  // mm
  const double extent = (box.max - box.min).maxCoeff();
  if (!(extent > kHuge)) return std::nullopt;
  return MakeWarning(
      "SUSPICIOUS_SIZE",
      fmt::format("the model is {:.4g} mm large; are the unit of the file and the scale right?", extent));
}

absl::StatusOr<PreparedJob> PrepareJob(const v1::Job& job, const v1::Post& post, const RunContext& run,
                                       const ModelAccess& models) {
  PreparedJob prepared;
  FieldErrors errors;
  prepared.job = FromProto(job, post, "job", errors);
  prepared.name = job.name();
  PM_RETURN_IF_ERROR(errors.ToStatus());
  PM_ASSIGN_OR_RETURN(LoadedModel loaded, LoadModel(job.source(), "job.source", run, models));
  PM_RETURN_IF_ERROR(RequireSound(loaded));
  PM_RETURN_IF_ERROR(run.Check());
  PM_ASSIGN_OR_RETURN(UprightModel upright, MakeUpright(std::move(loaded), prepared.job.setup, run));
  prepared.model = std::move(upright.model);
  prepared.job.setup = std::move(upright.setup);
  PM_RETURN_IF_ERROR(LoadStock(job.setup().stock(), "job.setup.stock", prepared.job.setup, run, models));
  prepared.job.unitless_file = prepared.model.unitless;
  prepared.job.model_remarks = Placed(prepared.model.remarks, prepared.job.setup.placement);
  prepared.job.path_limits = {.length = limits::kMaxCutLengthMm, .points = limits::kMaxPathPoints};
  prepared.digest = JobDigest(prepared.job, prepared.model.digest, prepared.name);
  if (!prepared.name.empty()) prepared.job.header.push_back("part: " + prepared.name);
  prepared.job.header.push_back(fmt::format("made by Patchmill {}", ServerVersion()));
  prepared.job.header.push_back("request sha256: " + Hex(prepared.digest));
  for (const Diagnostic& remark : HeaderRemarks(prepared.model.remarks)) {
    prepared.job.header.push_back(remark.code + ": " + remark.message);
  }
  return prepared;
}

}  // namespace patchmill
