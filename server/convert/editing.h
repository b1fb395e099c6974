// v1.ModelEdit -> NetworkEdit, and an edited network back into its message.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "core/editing/edit_network.h"
#include "patchmill/v1/editing.pb.h"

namespace patchmill {

// `unit`: mm of one length unit. INVALID_ARGUMENT with all wrong fields; RESOURCE_EXHAUSTED for too many
// edits.
absl::StatusOr<std::vector<NetworkEdit>> FromProto(
    const google::protobuf::RepeatedPtrField<v1::ModelEdit>& edits, double unit);

// Writes into `proto`, the message of `before`, what differs in `after`; the rest stays to the bit.
void WriteEdited(const CurveNetwork& before, const CurveNetwork& after, double unit, v1::CurveNetwork* proto);

// What EditNetwork says of "edits[k].face" and the like, with the field's path in the request.
absl::Status WithFieldPath(const absl::Status& status,
                           const google::protobuf::RepeatedPtrField<v1::ModelEdit>& edits);

}  // namespace patchmill
