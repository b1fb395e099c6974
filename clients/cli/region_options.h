// Regions cut in a way of their own, or not at all: options and the messages they become.
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

// Into regions_sha256 and region_overrides. INVALID_ARGUMENT names the option.
absl::Status SetRegions(const RegionChangeOptions& options, std::string* sha256,
                        google::protobuf::RepeatedPtrField<v1::RegionOverride>* overrides);

}  // namespace patchmill::cli
