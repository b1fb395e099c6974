// What the service owes whatever bytes a client sends as a model. Used by the fuzz target and by its replay
// in tests/service.
#pragma once

#include <string>

#include "core/network/control_points.h"
#include "core/network/patch_network.h"
#include "server/convert/model.h"
#include "server/errors.h"
#include "server/limits.h"
#include "server/model_source.h"

namespace patchmill {

// Either one clear error small enough for the wire, or a model with every fault listed; one without faults
// goes through BuildNetwork when it is small, and comes back unchanged from the contract.
inline bool KeepsModelSourceContract(const std::string& format, const std::string& content) {
  v1::ModelSource source;
  source.mutable_file()->set_format(format);
  source.mutable_file()->set_content(content);
  const absl::StatusOr<LoadedModel> loaded = LoadModel(source, "source");
  if (!loaded.ok()) {
    const grpc::Status status = ToGrpcStatus(loaded.status());
    const bool expected = loaded.status().code() == absl::StatusCode::kInvalidArgument ||
                          loaded.status().code() == absl::StatusCode::kResourceExhausted;
    return expected && !status.error_message().empty() &&
           status.error_message() == Utf8(status.error_message()) &&
           status.error_details().size() <= limits::kMaxStatusBytes;
  }
  for (const Diagnostic& fault : loaded->faults) {
    if (fault.code.empty() || fault.message.empty() || fault.severity != Severity::kError) return false;
  }
  if (!loaded->faults.empty()) return !ToGrpcStatus(ModelInvalidError(loaded->faults, loaded->path)).ok();
  const auto again = FromProto(ToProto(loaded->model), "again");
  if (!again.ok() || !again->faults.empty()) return false;
  std::size_t points = 0;
  for (const Patch& patch : loaded->model.patches) points += ControlPoints(patch.shape).size();
  return points > 2000 || BuildNetwork(loaded->model).ok();
}

}  // namespace patchmill
