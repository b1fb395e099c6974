// Which outputs a request asks for.
#pragma once

#include <set>

#include <absl/status/statusor.h>
#include <google/protobuf/repeated_field.h>

#include "patchmill/v1/job.pb.h"

namespace patchmill {

using Outputs = std::set<int>;  // of v1::Output

// What was asked for, or `defaults`. INVALID_ARGUMENT for one that is not in `possible`, UNIMPLEMENTED for
// one that only has its place reserved.
absl::StatusOr<Outputs> ReadOutputs(const google::protobuf::RepeatedField<int>& asked,
                                    const Outputs& possible, const Outputs& defaults);

}  // namespace patchmill
