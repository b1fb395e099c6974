// Options for the part of the model that is cut and for places that the tool keeps off, and the messages made
// of them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <absl/status/status.h>

#include "patchmill/v1/operation.pb.h"
#include "patchmill/v1/setup.pb.h"

namespace patchmill::cli {

struct LimitOptions {
  std::vector<std::string> only, avoid, boundary, obstacles;
  std::string boundary_mode = "center";
  double avoid_margin = 0.0, boundary_offset = 0.0;
  std::optional<double> top;
  bool outside = false;
};

void AddLimitOptions(CLI::App& app, LimitOptions& options);

// Adds the obstacles to the set-up and fills the selection if an option sets it. INVALID_ARGUMENT names the
// option.
absl::Status SetLimits(const LimitOptions& options, v1::Setup& setup, v1::Selection& selection);
// Reads a ring into packed x y from its points "X,Y X,Y X,Y", or from a file "@FILE" of them.
// INVALID_ARGUMENT names the option or the file.
absl::Status ReadRing(const std::string& text, const std::string& option,
                      google::protobuf::RepeatedField<double>* xy);
// Whether an option sets the selection.
bool Selects(const LimitOptions& options);

}  // namespace patchmill::cli
