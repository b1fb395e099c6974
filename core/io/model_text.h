// Model text of any known format.
#pragma once

#include <string_view>

#include <absl/status/statusor.h>

#include "core/network/patch_model.h"

namespace patchmill {

// `format` is the file's ending without the point: "bpt", "bv", "bez" or "patches"; text formats are told by
// it alone, for a truncated .bpt can be a valid .bv. An unknown one is INVALID_ARGUMENT and lists those
// known; else as the reader.
absl::StatusOr<PatchModel> ReadModelText(std::string_view format, std::string_view text);

}  // namespace patchmill
