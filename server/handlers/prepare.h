// What the handlers share: a request's job checked, its model loaded, its limits set.
#pragma once

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
  std::string name;    // what the part is called
};

// All field errors of job and post together with those of the model. Nothing is refused for what it might
// come to: the job has limits::kMaxCutLengthMm and kMaxPathPoints with it, and ends when its passes come to
// more.
absl::StatusOr<PreparedJob> PrepareJob(const v1::Job& job, const v1::Post& post, const RunContext& run,
                                       InFlight& in_flight);

// INVALID_ARGUMENT for a field this version does not know: refused, never silently ignored.
absl::Status RefuseUnknownFields(const google::protobuf::Message& request);

// With their points as placed.
Diagnostics Placed(Diagnostics remarks, const Placement& placement);

// OK for a usable model, MODEL_INVALID with the faults for another.
absl::Status RequireSound(const LoadedModel& model);

}  // namespace patchmill
