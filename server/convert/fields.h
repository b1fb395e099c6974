// Checks of single fields of a request. Each takes one line where it is used.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "server/errors.h"

namespace patchmill {

// The path of a message within the request: At("job", "setup") is "job.setup".
inline std::string At(std::string_view parent, std::string_view child) {
  return parent.empty() ? std::string(child) : fmt::format("{}.{}", parent, child);
}

// `constraint` completes "must be ...". NaN and infinity never pass.
inline bool Require(FieldErrors& errors, std::string field, double value, bool ok,
                    std::string_view constraint) {
  if (ok && std::isfinite(value)) return true;
  errors.Add(std::move(field), fmt::format("= {:.10g}; must be {}", value, constraint));
  return false;
}

inline void RequireBytes(FieldErrors& errors, std::string field, std::string_view value, std::size_t most) {
  if (value.size() > most) {
    errors.Add(std::move(field), fmt::format("has {} bytes; must have at most {}", value.size(), most));
  }
}

}  // namespace patchmill
