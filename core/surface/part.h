// Makes some patches of a surface a surface of their own.
#pragma once

#include <vector>

#include "core/surface/surface.h"

namespace patchmill {

// Takes the patches with patches[i] set, in their order and in place. They are joined within the same
// tolerance, as far as a part of this size may have it. `patches` must have one entry per patch of the model
// and at least one of them set. Cost and errors are those of BuildNetwork and BuildSurface.
absl::StatusOr<Surface> PartOf(const Surface& surface, const std::vector<bool>& patches,
                               const RunContext& run);

}  // namespace patchmill
