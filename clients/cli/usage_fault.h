// Says in plain words what is wrong with a command line.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace patchmill::cli {

// Lines that say what is wrong, what is valid, and where there is help. Unknown words come first: they may be
// what everything else is about.
std::string UsageFault(const CLI::App& app, const CLI::ParseError& error);

}  // namespace patchmill::cli
