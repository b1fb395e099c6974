// Checks the arrays of an answer before they are drawn: a server of another version, or one that is no
// Patchmill, may send anything.
#pragma once

#include <vector>

#include <absl/status/status.h>

#include "patchmill/v1/region.pb.h"
#include "patchmill/v1/toolpath.pb.h"

namespace patchmill::cli {

// OK if the arrays of each block belong together, their numbers are finite, and all corners, patches and
// kinds are some that there are. Otherwise DATA_LOSS that names the array, the number and what it must be.
absl::Status CheckMesh(const std::vector<v1::MeshBlock>& mesh);
absl::Status CheckPaths(const std::vector<v1::PathBlock>& paths);
absl::Status CheckBorders(const v1::RegionMap& map);

}  // namespace patchmill::cli
