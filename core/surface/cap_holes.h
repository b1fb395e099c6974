// Closes round holes of a part at their mouths, so that a finish runs over them.
#pragma once

#include <absl/status/statusor.h>

#include "core/base/diagnostic.h"
#include "core/base/run_context.h"
#include "core/network/patch_model.h"

namespace patchmill {

struct CappedModel {
  PatchModel model;
  // HOLES_CAPPED (info): how many, and which; HOLE_NOT_CAPPED (warning): a hole that stays, and why.
  Diagnostics findings;
};

// Caps the holes (FindHoles) of a sound model whose diameter is at most `diameter`, mm in the model's own
// frame. A mouth is the rim of the hole's wall at an open end, or the outer circle of the chamfer or rounding
// around it, if that is at most `diameter` wide. The cap joins each point of the mouth to its middle by a
// straight line: it is plane where the mouth is, and its border is the mouth exactly. The faces behind the
// caps, those of floors and of other holes that open into this one too, are taken out of the model; each
// mouth's cap is a new face, "cap1" and so on.
//
// A hole stays where its inside leads to the outside by another way, where the edges around a mouth do not
// close, where a mouth lies off its plane by more than a tenth of the hole's diameter, or where something
// inside stands out of a mouth, as a pin does. Cost: that of a network, a surface, and FindHoles. Errors:
// those of `run`. A model without faces comes back as it is.
absl::StatusOr<CappedModel> CapHoles(PatchModel model, double diameter, const RunContext& run);

}  // namespace patchmill
