#include "server/handlers/prepare.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "cam/path/pass_params.h"
#include "cam/plan/quickest_angles.h"
#include "cam/plan/resolve.h"
#include "core/base/status.h"
#include "server/call.h"
#include "server/convert/job.h"
#include "server/digest.h"
#include "server/limits.h"
#include "server/unknown_fields.h"

namespace patchmill {
namespace {

// Passes over the control points' box, its plan and its walls, at the flat step-over: an estimate that costs
// nothing.
absl::Status CheckPathSize(const Job& job, const PatchModel& model) {
  const Box3 box = Place(job.setup.placement, ControlBox(model));
  const Vec3 size = box.max - box.min;
  const double radius = BallRadius(job.operation.tool) + job.operation.leave;
  // Contours are made over the whole part for every scallop in use.
  std::set<double> scallops = {job.operation.scallop};
  for (const RegionOverride& change : job.operation.overrides) {
    scallops.insert(change.scallop.value_or(job.operation.scallop));
  }
  const double h = *scallops.begin();
  const double step = 2.0 * std::sqrt(h * (2.0 * radius - h));
  const double once = (size.x() * size.y() + 2.0 * (size.x() + size.y()) * size.z()) / step;
  const double length = static_cast<double>(scallops.size()) * once;
  // What is planned is work, what is kept of it is one plan.
  const double planned = job.operation.angle_auto ? kQuickestAnglePlans * length : length;
  if (!(planned <= limits::kMaxCutLengthMm)) {
    return LimitError("estimated_cut_length_mm", limits::kMaxCutLengthMm, planned);
  }
  const double sagitta =
      std::min(SplitBudget(job.operation.tolerance).chord, kGougeOfScallop * std::max(h, kFinestScallop));
  const double points = length / (2.0 * std::sqrt(sagitta * (2.0 * radius - sagitta)));
  if (points <= limits::kMaxPathPoints) return absl::OkStatus();
  return LimitError("estimated_point_count", limits::kMaxPathPoints, points);
}

}  // namespace

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

Diagnostics Placed(Diagnostics remarks, const Placement& placement) {
  for (Diagnostic& remark : remarks) {
    if (remark.where.point) remark.where.point = Place(placement, *remark.where.point);
  }
  return remarks;
}

absl::StatusOr<PreparedJob> PrepareJob(const v1::Job& job, const v1::Post& post, const RunContext& run) {
  PreparedJob prepared;
  FieldErrors errors;
  prepared.job = FromProto(job, post, "job", errors);
  prepared.name = job.name();
  PM_RETURN_IF_ERROR(errors.ToStatus());
  PM_ASSIGN_OR_RETURN(prepared.model, LoadModel(job.source(), "job.source", run));
  PM_RETURN_IF_ERROR(RequireSound(prepared.model));
  prepared.job.unitless_file = prepared.model.unitless;
  prepared.job.model_remarks = Placed(prepared.model.remarks, prepared.job.setup.placement);
  PM_RETURN_IF_ERROR(CheckPathSize(prepared.job, prepared.model.model));
  prepared.digest = JobDigest(prepared.job, prepared.model.digest, prepared.name);
  if (!prepared.name.empty()) prepared.job.header.push_back("part: " + prepared.name);
  prepared.job.header.push_back(fmt::format("made by Patchmill {}", ServerVersion()));
  prepared.job.header.push_back("request sha256: " + Hex(prepared.digest));
  return prepared;
}

}  // namespace patchmill
