// What users call the fields of requests.
#pragma once

#include <string_view>

namespace patchmill::cli {

// The option behind the field path at the start of `text` (up to a blank); null: none is known.
const char* OptionOf(std::string_view text);

}  // namespace patchmill::cli
