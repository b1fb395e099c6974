// v1.RegionOverride <-> RegionOverride.
#pragma once

#include <string>
#include <string_view>

#include <google/protobuf/repeated_field.h>

#include "cam/plan/job.h"
#include "patchmill/v1/operation.pb.h"
#include "server/errors.h"

namespace patchmill {

// Fills op.regions_sha256 and op.overrides; op.tool must be filled before. `at` is the path of the message
// that has the two fields. ChooseRegions checks later, with the regions, whether they exist.
void ReadOverrides(const std::string& regions_sha256,
                   const google::protobuf::RepeatedPtrField<v1::RegionOverride>& overrides,
                   std::string_view at, Operation& op, FieldErrors& errors);

v1::RegionOverride ToProto(const RegionOverride& change);

}  // namespace patchmill
