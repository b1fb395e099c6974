// v1.Patch <-> Patch.
#pragma once

#include "core/base/diagnostic.h"
#include "core/network/patch_model.h"
#include "patchmill/v1/model.pb.h"

namespace patchmill {

// Reads a patch into mm. `unit` is the length unit of the message in mm. Faults that only a message can have
// are added to `faults` with `index`, the position of the patch in the model. ValidateModel finds the
// others.
Patch FromProto(const v1::Patch& proto, double unit, int index, Diagnostics& faults);

// The message of a patch, in millimetres.
v1::Patch ToProto(const Patch& patch);

}  // namespace patchmill
