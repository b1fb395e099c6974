// Evaluates the expressions of RS274/NGC: [25 - [0.01 * SQRT[2]]].
#pragma once

#include <cstddef>
#include <string_view>

#include <absl/status/statusor.h>

namespace patchmill {

// Reads a value at `at` and moves `at` behind it: a number, an expression in square brackets, or a function
// of one. Operators: ** before * / MOD before + -, each from left to right. Functions: ABS, ACOS, ASIN,
// ATAN[]/[], COS, EXP, FIX, FUP, LN, ROUND, SIN, SQRT, TAN; angles are in degrees. `code` has no blanks and
// is in upper case. INVALID_ARGUMENT (without the line number) for parameters (#), for comparisons, for a
// value that is not finite, and for brackets more than 20 deep.
absl::StatusOr<double> ReadGcodeValue(std::string_view code, std::size_t& at);

}  // namespace patchmill
