#include <vector>

#include <fmt/format.h>

#include "core/base/status.h"
#include "core/editing/changed_faces.h"
#include "core/joining/continuity.h"
#include "core/joining/join_network.h"
#include "core/joining/network_findings.h"
#include "server/convert/editing.h"
#include "server/convert/joints.h"
#include "server/convert/report.h"
#include "server/convert/write_edited.h"
#include "server/handlers/handlers.h"
#include "server/handlers/prepare.h"
#include "server/limits.h"

namespace patchmill {
namespace {

absl::Status Edit(const Call& call, const v1::EditModelRequest& request, const RunContext& run,
                  v1::EditModelResponse* response) {
  PM_ASSIGN_OR_RETURN(LoadedNetwork loaded, LoadNetwork(request.source(), "source", run, ModelsOf(call)));
  const auto findings = [response](const Diagnostics& list) {
    AddDiagnostics(list, Vec3::Zero(), response->mutable_diagnostics());
  };
  v1::PatchModel& message = *response->mutable_model() = std::move(loaded.message);
  if (!loaded.checked.faults.empty()) {
    findings(loaded.checked.faults);
    return absl::OkStatus();
  }
  PM_ASSIGN_OR_RETURN(const std::vector<NetworkEdit> edits, FromProto(request.edits(), loaded.checked.unit));
  const CurveNetwork& before = loaded.checked.network;
  auto edited = EditNetwork(before, edits, run);
  if (!edited.ok()) return WithFieldPath(edited.status(), request.edits());
  findings(GoalFindings(*edited, request.edits()));
  AddReached(*edited, loaded.checked.unit, response->mutable_goals());
  const CurveNetwork after = std::move(edited->network);
  WriteEdited(before, after, {loaded.checked.unit, edited->edge_of}, message.mutable_network());
  PM_ASSIGN_OR_RETURN(JoinedNetwork joined, JoinNetwork(after, run));
  findings(joined.findings);
  if (HasError(joined.findings)) return absl::OkStatus();
  if (const Diagnostics faults = ValidateModel(joined.model); !faults.empty()) {
    findings(faults);
    return absl::OkStatus();
  }
  PM_ASSIGN_OR_RETURN(const JoinedNetwork joined_before, JoinNetwork(before, run));
  if (!joined_before.model.patches.empty()) {
    const std::vector<int> changed = ChangedFaces(joined_before, joined);
    response->mutable_changed_faces()->Add(changed.begin(), changed.end());
  }
  if (request.with_patches()) *response->mutable_patches() = ToProto(joined.model);
  if (request.continuity_steps() == 0) return absl::OkStatus();
  PM_ASSIGN_OR_RETURN(const PatchNetwork network, BuildNetwork(std::move(joined.model), run));
  PM_ASSIGN_OR_RETURN(const ContinuityReport report,
                      MeasureContinuity(network, request.continuity_steps(), run));
  AddJoints(report, response->mutable_joints());
  return absl::OkStatus();
}

}  // namespace

absl::Status HandleEditModel(const Call& call, const v1::EditModelRequest& request,
                             v1::EditModelResponse* response) {
  PM_RETURN_IF_ERROR(RefuseUnknownFields(request));
  PM_RETURN_IF_ERROR(CheckThreads(request.max_threads(), "max_threads"));
  if (const int steps = request.continuity_steps(); steps < 0 || steps > limits::kMaxContinuitySteps) {
    FieldErrors errors;
    errors.Add("continuity_steps",
               fmt::format("= {}; must be in [0, {}]", steps, limits::kMaxContinuitySteps));
    return errors.ToStatus();
  }
  return RunQuickCall(call, {.max_threads = request.max_threads()},
                      [&](const RunContext& run) { return Edit(call, request, run, response); });
}

}  // namespace patchmill
