// The two readers behind ReadCadFile.
#pragma once

#include <string_view>

#include <absl/status/status.h>

#include "import/occt/read_file.h"

namespace patchmill {

// Fill everything but `sewing`, "wires" and "points". INVALID_ARGUMENT for what cannot be read or has no
// shape. May throw Standard_Failure.
absl::Status ReadStep(std::string_view content, CadFile& file);
absl::Status ReadIges(std::string_view content, CadFile& file);

}  // namespace patchmill
