// The .bez format: Geomview's tensor Bezier patches.
#pragma once

#include <string_view>

#include <absl/status/statusor.h>

#include "core/network/patch_model.h"

namespace patchmill {

// First BBP (bicubic, x y z) or BEZabc: degree a in u, b in v, each 1 to 6 as Geomview has them, c numbers
// per point: 3, or 4 with the weight last, x y z already multiplied by it. Then patch after patch until the
// text ends, (a+1)(b+1) points each, u FASTEST. # starts a comment. Texture coordinates (STBBP, BEZabc_ST)
// and colours (CBEZabc) are refused by name. Weights must be positive: a weight of 0 is a point at infinity
// and is refused with the code ZERO_WEIGHT. Errors: INVALID_ARGUMENT "line 12: reason" for anything else.
// Cost O(text), memory a small multiple of it.
absl::StatusOr<PatchModel> ReadBez(std::string_view text);

}  // namespace patchmill
