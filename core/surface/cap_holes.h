// Closes round holes of a part at their mouths, so that a finish runs over them.
#pragma once

#include <absl/status/statusor.h>

#include "core/base/diagnostic.h"
#include "core/base/run_context.h"
#include "core/network/patch_model.h"

namespace patchmill {

struct CapParams {
  double diameter = 0.0;  // mm, > 0, of the placed model: the widest hole that is capped
  double scale = 1.0;     // > 0: by which the model is scaled when it is placed
};

struct CappedModel {
  PatchModel model;
  // HOLES_CAPPED (info; a warning for a model without faces): how many, and which. HOLE_NOT_CAPPED
  // (warning): a hole that stays, and why. Lengths are those of the placed model, points are in the
  // model's own frame.
  Diagnostics findings;
};

// Caps the holes (FindHoles) of a sound model, before it is placed, whose diameter is at most the one
// given. A mouth is the rim of the hole's wall at an open end, or the outer circle of the chamfer or
// rounding around it, if that is no wider. The cap joins each point of the mouth to its middle by a
// straight line: it is plane where the mouth is, and its border is the mouth exactly. The faces behind the
// caps, those of floors and of other holes that open into this one too, are taken out of the model; each
// mouth's cap is a new face, "cap1" and so on.
//
// A hole stays where its inside leads to the outside by another way, where the edges around a mouth do not
// close, where a mouth lies off its plane by more than a tenth of the hole's diameter, or where something
// inside stands out of a mouth, as a pin does. Cost: that of a network, a surface, and FindHoles. Errors:
// those of `run`. A model without faces comes back as it is.
absl::StatusOr<CappedModel> CapHoles(PatchModel model, const CapParams& params, const RunContext& run);

}  // namespace patchmill
