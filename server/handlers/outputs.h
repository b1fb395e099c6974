// The outputs that a request wants.
#pragma once

#include <set>

#include <absl/status/statusor.h>
#include <google/protobuf/repeated_field.h>

#include "patchmill/v1/job.pb.h"

namespace patchmill {

using Outputs = std::set<int>;  // of v1::Output

// The requested outputs, or `defaults` if none are requested. INVALID_ARGUMENT for an output that is not in
// `possible`.
absl::StatusOr<Outputs> ReadOutputs(const google::protobuf::RepeatedField<int>& asked,
                                    const Outputs& possible, const Outputs& defaults);

}  // namespace patchmill
