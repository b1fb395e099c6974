// v1.Face <-> ModelFace. Holes and concave faces of a model as messages.
#pragma once

#include "cam/plan/concave_faces.h"
#include "core/base/diagnostic.h"
#include "core/network/patch_model.h"
#include "core/surface/holes.h"
#include "patchmill/v1/model.pb.h"
#include "patchmill/v1/model_service.pb.h"

namespace patchmill {

// Reads a face. Faults that only a message can have are added to `faults` with `index`, the position of the
// face in the model. ValidateModel finds the others.
ModelFace FromProto(const v1::Face& proto, int index, Diagnostics& faults);

// The message of a face, in millimetres.
v1::Face ToProto(const ModelFace& face);

// The messages name faces by their ids in `model`. `zero`: the program's zero on the machine, mm.
v1::Hole ToProto(const Hole& hole, const PatchModel& model, const Vec3& zero);
v1::ConcaveFaces ToProto(const ConcaveFaces& group, const PatchModel& model);

}  // namespace patchmill
