// Numbers and comments as a control can read them: no exponent, no "-0", ASCII only.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "cam/post/dialect.h"

namespace patchmill {

// A coordinate in units of its last decimal. Two positions that print alike are equal as ticks.
std::int64_t ToTicks(double value, int decimals);
std::string FormatTicks(std::int64_t ticks, int decimals);  // "-12.0040"
// Up to `decimals` decimals, trailing zeros and point dropped: "1200", "0.5". Not for coordinates.
std::string FormatShort(double value, int decimals);

// One comment line or several: ASCII, comment marks replaced, wrapped, never read as a command of the control
// ("MSG,", "DEBUG,", ... at the start of a comment are).
std::vector<std::string> CommentLines(const Dialect& dialect, std::string_view text);

}  // namespace patchmill
