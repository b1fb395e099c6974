// ContinuityReport -> v1.EdgeContinuity.
#pragma once

#include "core/joining/continuity.h"
#include "patchmill/v1/model_service.pb.h"

namespace patchmill {

void AddJoints(const ContinuityReport& report,
               google::protobuf::RepeatedPtrField<v1::EdgeContinuity>* joints);

}  // namespace patchmill
