// Files that a request in JSON names: the command line puts their bytes into the request.
#pragma once

#include <filesystem>
#include <string>

#include <absl/status/statusor.h>

namespace patchmill::cli {

// Replaces each member "file": "NAME" of `json` by the message CurveInFile with the file's bytes, and with
// its ending as the format. A relative NAME is looked up from `folder`. Lines of `json` keep their numbers.
// Text that is no JSON comes back as it is, for the reader of the request to refuse. Errors name the file.
absl::StatusOr<std::string> PutFilesIntoJson(const std::string& json, const std::filesystem::path& folder);

}  // namespace patchmill::cli
