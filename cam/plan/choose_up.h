// Turns a model as its set-up asks: by the table of up directions, or by the normal of a plane face.
#pragma once

#include <absl/status/statusor.h>

#include "cam/plan/job.h"
#include "core/base/diagnostic.h"
#include "core/base/run_context.h"

namespace patchmill {

struct ChosenUp {
  Setup setup;  // its placement is definite
  Diagnostics
      findings;  // UP_CHOSEN (info): what points up and why; empty if the set-up named the axis itself
};

// Makes Setup::up_auto and Setup::up_face definite for a sound model (ValidateModel), before it is placed.
// The axis is that of BestUp in the table that CheckModel answers with. A face is turned up by the smallest
// rotation; an axis within kSnapToAxis of its normal is taken for it, so that upright walls stay exactly
// upright. Costs a surface and its table for up_auto, else next to nothing. INVALID_ARGUMENT, with the field,
// for up_auto without faces and for a face that is missing, has no patches or is no plane; CANCELLED and
// DEADLINE_EXCEEDED from `run`.
absl::StatusOr<ChosenUp> ChooseUp(const PatchModel& model, Setup setup, const RunContext& run);

inline constexpr double kSnapToAxis = 1e-9;  // of each coordinate of a unit normal

}  // namespace patchmill
