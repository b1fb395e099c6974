// v1.Patch <-> Patch.
#pragma once

#include "core/base/diagnostic.h"
#include "core/network/patch_model.h"
#include "patchmill/v1/model.pb.h"

namespace patchmill {

// In mm; `unit`: mm of one of the message's. What only the wire can get wrong is added to `faults`, with the
// patch's `index` in the model; the rest is ValidateModel's.
Patch FromProto(const v1::Patch& proto, double unit, int index, Diagnostics& faults);

// The other way, in millimetres.
v1::Patch ToProto(const Patch& patch);

}  // namespace patchmill
