// Formats numbers and comments so that a control can read them: no exponent, no "-0", ASCII only.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "cam/post/dialect.h"

namespace patchmill {

// A coordinate in units of its last decimal (ticks). Two positions have the same text if and only if their
// ticks are equal.
std::int64_t ToTicks(double value, int decimals);
std::int64_t ToTicks(double mm, const Dialect& dialect, ProgramUnit unit);
std::string FormatTicks(std::int64_t ticks, int decimals);  // "-12.0040"
// Up to `decimals` decimals, without trailing zeros and point: "1200", "0.5". Not for coordinates.
std::string FormatShort(double value, int decimals);

// The text as one or more comment lines: in ASCII, wrapped, with comment marks replaced. No line is read as a
// command of the control, as a comment that starts with "MSG,", "DEBUG," and so on would be.
std::vector<std::string> CommentLines(const Dialect& dialect, std::string_view text);

}  // namespace patchmill
