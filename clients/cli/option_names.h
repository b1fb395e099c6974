// Names of options for fields of requests.
#pragma once

#include <string_view>

namespace patchmill::cli {

// The option that sets the field whose path begins `text` (up to a blank); null if there is none.
const char* OptionOf(std::string_view text);

}  // namespace patchmill::cli
