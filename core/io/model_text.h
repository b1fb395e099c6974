// Model text of any known format.
#pragma once

#include <string_view>

#include <absl/status/statusor.h>

#include "core/base/diagnostic.h"
#include "core/network/patch_model.h"

namespace patchmill {

// `format` is the file's ending without the point: "bpt", "bv", "bez" or "patches". The format is never
// guessed from the text, because a truncated .bpt can be a valid .bv. An unknown format is INVALID_ARGUMENT,
// and the message lists the known ones. Other errors are those of the reader. What a reader has left out is
// added to `remarks` (may be null).
absl::StatusOr<PatchModel> ReadModelText(std::string_view format, std::string_view text,
                                         Diagnostics* remarks = nullptr);

}  // namespace patchmill
