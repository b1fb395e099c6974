// The .bpt format: polynomial tensor Bezier patches.
#pragma once

#include <string>
#include <string_view>

#include <absl/status/statusor.h>

#include "core/network/patch_model.h"

namespace patchmill {

// The text starts with the number of patches. Each patch is `degree-u degree-v` and (u+1)(v+1) points `x y
// z`, v fastest. White space is free. All errors, missing and surplus text included, are INVALID_ARGUMENT
// "line 12: reason". Cost O(text); memory is a small multiple of the text.
absl::StatusOr<PatchModel> ReadBpt(std::string_view text);

// `digits` is the number of significant digits; 17 keep every double. INVALID_ARGUMENT for a patch that .bpt
// cannot hold (rational, or not a tensor Bezier patch).
absl::StatusOr<std::string> WriteBpt(const PatchModel& model, int digits = 17);

}  // namespace patchmill
