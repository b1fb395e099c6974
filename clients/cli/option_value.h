// How the value of an option is shown: in the help, in the manual page, and to a shell that completes it.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace patchmill::cli {

// The words of a list that the value is one of; empty for any other value.
std::vector<std::string> ChoicesOf(const CLI::Option& option);

// Whether the value is a number, or some numbers.
bool TakesNumber(const CLI::Option& option);

// "auto|contour|zigzag", "NUMBER", "X,Y,Z", "FILE", "HOST:PORT" or "TEXT", with "..." for several; empty for
// flags and positional arguments, whose name says it.
std::string ValueName(const CLI::Option& option);

// The description on one line, with range, default, and the options that belong to this one or exclude it.
std::string DescriptionOf(const CLI::Option& option);

}  // namespace patchmill::cli
