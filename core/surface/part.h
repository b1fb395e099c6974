// Some patches of a surface as a surface of their own.
#pragma once

#include <vector>

#include "core/surface/surface.h"

namespace patchmill {

// The patches with patches[i] set, in their order, in place, joined within the same tolerance; `patches` has
// one entry per patch of the model and at least one set. Cost and errors as BuildNetwork and BuildSurface.
absl::StatusOr<Surface> PartOf(const Surface& surface, const std::vector<bool>& patches,
                               const RunContext& run);

}  // namespace patchmill
