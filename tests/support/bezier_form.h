// Models as text formats can hold them.
#pragma once

#include "core/network/patch_model.h"

namespace patchmill::testing {

// Every tensor B-spline replaced by its Bezier patches (one per span rectangle, in order of u span, then v
// span); exact. Other patches stay. Ids are dropped.
PatchModel BezierForm(const PatchModel& model);

}  // namespace patchmill::testing
