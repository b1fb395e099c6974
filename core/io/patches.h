// The .patches format: plain text for Bezier quads and triangles and Gregory quads.
#pragma once

#include <string>
#include <string_view>

#include <absl/status/statusor.h>

#include "core/network/patch_model.h"

namespace patchmill {

// First line `patches N`; each patch is a key line and its points `x y z`:
//   bezier p q   (p+1)(q+1) points, u FASTEST (unlike the other formats)
//   triangle n   row after row as .bv kind 3
//   gregory4     20 points, five at each corner (see GregoryPatch); corner blend
// `gregory3` (Gregory triangles) is refused by name: the project has no such patch yet. Errors:
// INVALID_ARGUMENT "line 12: reason" for anything else. Cost O(text), memory a small multiple of it.
absl::StatusOr<PatchModel> ReadPatches(std::string_view text);

// `digits`: significant ones; 17 keep every double. INVALID_ARGUMENT for B-splines, rational patches and
// Gregory quads with edge blend.
absl::StatusOr<std::string> WritePatches(const PatchModel& model, int digits = 17);

}  // namespace patchmill
