// The stock of a set-up, between message and value.
#pragma once

#include <string_view>

#include "cam/plan/job.h"
#include "patchmill/v1/setup.pb.h"
#include "server/errors.h"

namespace patchmill {

// Reads the stock into the set-up. Findings name fields below `at`.
void ReadStock(const v1::Stock& proto, std::string_view at, Setup& setup, FieldErrors& errors);
v1::Stock StockToProto(const Setup& setup);

}  // namespace patchmill
