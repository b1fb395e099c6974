// The options of `patchmill fair` as values, and the requests made of them.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <absl/status/statusor.h>

#include "clients/cli/connection.h"
#include "patchmill/v1/fairing.pb.h"

namespace patchmill::cli {

struct FairOptions {
  CommonOptions common;
  std::vector<std::string> files;  // as given; several are sections, each faired by itself
  std::string points;              // the one that is faired
  std::string output, polyline, preview;
  std::string axes = "xyz", band = "0.2%", band_rule = "least", stop = "signs";
  std::string length_unit = "mm";  // of the points, stated in the outline that several files make
  std::vector<std::string> locks;
  std::string start_direction, end_direction;
  std::optional<double> tolerance;
  int iterations = 50;
  int net = 0;  // lines of a net; 0: a curve
  bool fit = false;
};

void AddFairOptions(CLI::App& app, FairOptions& options);

// The request for a curve. Reads the file of points. INVALID_ARGUMENT names the wrong option.
absl::StatusOr<v1::FairCurveRequest> MakeFairRequest(const FairOptions& options);

// The request for a net. INVALID_ARGUMENT also for options that only a curve has.
absl::StatusOr<v1::FairNetRequest> MakeFairNetRequest(const FairOptions& options);

}  // namespace patchmill::cli
