// Options for regions that are cut differently or not at all, and the messages made of them.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <absl/status/status.h>

#include "patchmill/v1/operation.pb.h"

namespace patchmill::cli {

struct RegionChangeOptions {
  std::vector<std::string> changes;
  std::string map;
};

void AddRegionChangeOptions(CLI::App& app, RegionChangeOptions& options);

// Fills regions_sha256 and region_overrides. INVALID_ARGUMENT names the option.
absl::Status SetRegions(const RegionChangeOptions& options, std::string* sha256,
                        google::protobuf::RepeatedPtrField<v1::RegionOverride>* overrides);

}  // namespace patchmill::cli
