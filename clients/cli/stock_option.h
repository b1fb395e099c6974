// Reads the option --stock.
#pragma once

#include <string>

#include <absl/status/status.h>

#include "clients/cli/job_options.h"
#include "patchmill/v1/setup.pb.h"

namespace patchmill::cli {

// Sets the body of the stock from "block[,MARGIN]", "cylinder,D[,X,Y]", "outline: X,Y X,Y ...",
// "outline:@FILE" or "model:FILE". INVALID_ARGUMENT names the option and what it must be.
absl::Status ReadStockBody(const std::string& text, const ReadingOptions& reading, v1::Stock& stock);

}  // namespace patchmill::cli
