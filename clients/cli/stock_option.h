// Reads the option --stock.
#pragma once

#include <string>

#include <absl/status/status.h>

#include "patchmill/v1/setup.pb.h"

namespace patchmill::cli {

// Sets the body of the stock from "block[,MARGIN]", "cylinder,D[,X,Y]", "outline: X,Y X,Y ..." or
// "outline:@FILE". INVALID_ARGUMENT names the option and what it must be.
absl::Status ReadStockBody(const std::string& text, v1::Stock& stock);

}  // namespace patchmill::cli
