// The dialects that programs are written for.
#pragma once

#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "clients/cli/connection.h"

namespace patchmill::cli {

// The names of all posts of the server, in its order.
absl::StatusOr<std::vector<std::string>> PostNames(const CommonOptions& options, InterruptWatch& watch);

}  // namespace patchmill::cli
