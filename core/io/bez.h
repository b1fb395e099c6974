// The .bez format: Geomview's tensor Bezier patches.
#pragma once

#include <string_view>

#include <absl/status/statusor.h>

#include "core/network/patch_model.h"

namespace patchmill {

// The text starts with BBP (bicubic, x y z) or BEZabc. Here a is the degree in u and b the degree in v, each
// 1 to 6 as in Geomview. The number c of coordinates per point is 3, or 4 if a weight comes last; x y z are
// then already multiplied by the weight. Patch after patch follows until the text ends. Each has (a+1)(b+1)
// points, u FASTEST. The character # starts a comment. Texture coordinates (STBBP, BEZabc_ST) and colours
// (CBEZabc) are refused by name. Weights must be positive. A weight of 0 is a point at infinity and is
// refused with the code ZERO_WEIGHT. All other errors are INVALID_ARGUMENT "line 12: reason". Cost O(text);
// memory is a small multiple of the text.
absl::StatusOr<PatchModel> ReadBez(std::string_view text);

}  // namespace patchmill
