// The .bpt format: polynomial tensor Bezier patches.
#pragma once

#include <string>
#include <string_view>

#include <absl/status/statusor.h>

#include "core/network/patch_model.h"

namespace patchmill {

// First the number of patches; each patch is `degree-u degree-v` and (u+1)(v+1) points `x y z`, v fastest.
// White space is free. Errors: INVALID_ARGUMENT "line 12: reason" for anything else, missing or surplus text
// included. Cost O(text), memory a small multiple of it.
absl::StatusOr<PatchModel> ReadBpt(std::string_view text);

// `digits`: significant ones; 17 keep every double. INVALID_ARGUMENT for a patch that .bpt cannot hold
// (rational, or not a tensor Bezier patch).
absl::StatusOr<std::string> WriteBpt(const PatchModel& model, int digits = 17);

}  // namespace patchmill
