// Steps that the handlers share: they check the job of a request, load its model and set its limits.
#pragma once

#include <optional>
#include <string>

#include <absl/status/statusor.h>

#include "cam/plan/job.h"
#include "patchmill/v1/job.pb.h"
#include "server/model_source.h"

namespace patchmill {

struct PreparedJob {
  Job job;
  LoadedModel model;
  std::string digest;  // of the whole request, 32 bytes
  std::string name;    // of the part
};

// Reads a job. Errors list all wrong fields of job, post and model together. No job is refused because of an
// estimate: it carries limits::kMaxCutLengthMm and kMaxPathPoints, and ends when its passes exceed them.
absl::StatusOr<PreparedJob> PrepareJob(const v1::Job& job, const v1::Post& post, const RunContext& run,
                                       const ModelAccess& models);

// INVALID_ARGUMENT for a field that this version does not know. Such a field is never ignored silently.
absl::Status RefuseUnknownFields(const google::protobuf::Message& request);

// A model whose holes are capped (Setup::cap_holes), and the set-up that its turn follows from (ChooseUp).
// What points up and why is among its remarks, and so is which holes are capped.
struct UprightModel {
  LoadedModel model;
  Setup setup;
};
absl::StatusOr<UprightModel> MakeUpright(LoadedModel model, const Setup& setup, const RunContext& run);

// Reads the model of a stock that has one, and places it as `setup` places the part (after MakeUpright).
// Other stock is left as it is. `at` is the path of the stock in its request. Errors as LoadModel.
absl::Status LoadStock(const v1::Stock& stock, std::string_view at, Setup& setup, const RunContext& run,
                       const ModelAccess& models);

// Those of the remarks that the header of a program states and every answer repeats. Without points.
Diagnostics HeaderRemarks(const Diagnostics& remarks);

// The remarks with their points in the placed frame.
Diagnostics Placed(Diagnostics remarks, const Placement& placement);

// The finding for a file without a unit, which is read as millimetres: an info, or a warning if the size
// looks wrong [machining M14].
Diagnostic UnitFinding(const Box3& box, const std::optional<Tool>& tool);

// SUSPICIOUS_SIZE for a model that is larger than machines are, whatever unit its file states
// [machining M14]; nullopt for any other.
std::optional<Diagnostic> HugeModelFinding(const Box3& box);

// OK for a model without faults, else MODEL_INVALID with the faults.
absl::Status RequireSound(const LoadedModel& model);

}  // namespace patchmill
