// The .patches format: plain text for Bezier and Gregory quads and triangles.
#pragma once

#include <string>
#include <string_view>

#include <absl/status/statusor.h>

#include "core/network/patch_model.h"

namespace patchmill {

// The first line is `patches N`. Each patch is a key line and its points `x y z`:
//   bezier p q   (p+1)(q+1) points, u FASTEST (unlike the other formats)
//   triangle n   row after row as .bv kind 3
//   gregory4     20 points, five at each corner (see GregoryPatch); corner blend
//   gregory3     18 points, five at each corner, then the middles of the edges (see GregoryTriangle);
//                corner blend
// All errors are INVALID_ARGUMENT "line 12: reason". Cost O(text); memory is a small multiple of the text.
absl::StatusOr<PatchModel> ReadPatches(std::string_view text);

// `digits` is the number of significant digits; 17 keep every double. INVALID_ARGUMENT for rational patches,
// Gregory patches with edge blend and all other kinds.
absl::StatusOr<std::string> WritePatches(const PatchModel& model, int digits = 17);

}  // namespace patchmill
