// Pages made of the options as the program has them: the manual page, and completion for bash.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace patchmill::cli {

// The manual page of all commands, in the macros of man(7).
std::string ManPage(const CLI::App& app, const std::string& version);

// A script for bash: after `source` the shell completes commands, options, their values where they are
// words of a list, and files.
std::string BashCompletion(const CLI::App& app);

}  // namespace patchmill::cli
