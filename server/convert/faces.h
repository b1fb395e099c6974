// v1.Face <-> ModelFace.
#pragma once

#include "core/base/diagnostic.h"
#include "core/network/model_face.h"
#include "patchmill/v1/model.pb.h"

namespace patchmill {

// Reads a face. Faults that only a message can have are added to `faults` with `index`, the position of the
// face in the model. ValidateModel finds the others.
ModelFace FromProto(const v1::Face& proto, int index, Diagnostics& faults);

// The message of a face, in millimetres.
v1::Face ToProto(const ModelFace& face);

}  // namespace patchmill
