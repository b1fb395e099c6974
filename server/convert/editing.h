// v1.ModelEdit -> NetworkEdit, and what edits have reached back into messages.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "core/editing/edit_network.h"
#include "patchmill/v1/editing.pb.h"

namespace patchmill {

// Reads the edits. `unit` is the length unit in mm. INVALID_ARGUMENT lists all wrong fields.
// RESOURCE_EXHAUSTED if there are too many edits.
absl::StatusOr<std::vector<NetworkEdit>> FromProto(
    const google::protobuf::RepeatedPtrField<v1::ModelEdit>& edits, double unit);

// Writes what goals have reached. `unit` is the length unit in mm.
void AddReached(const EditedNetwork& edited, double unit,
                google::protobuf::RepeatedPtrField<v1::ReachedGoal>* to);
// The findings about goals, with the paths of fields in the request.
Diagnostics GoalFindings(const EditedNetwork& edited,
                         const google::protobuf::RepeatedPtrField<v1::ModelEdit>& edits);

// Replaces paths of EditNetwork, such as "edits[k].face", by the path of the field in the request.
absl::Status WithFieldPath(const absl::Status& status,
                           const google::protobuf::RepeatedPtrField<v1::ModelEdit>& edits);

}  // namespace patchmill
