// The manual page, made of the options as the program has them.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace patchmill::cli {

// The manual page of all commands, in the macros of man(7).
std::string ManPage(const CLI::App& app, const std::string& version);

}  // namespace patchmill::cli
