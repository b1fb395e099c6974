// Completion for bash, made of the options as the program has them.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace patchmill::cli {

// A script for bash: after `source` the shell completes commands, options, their values where they are words
// of a list, `posts` (names of dialects) where a dialect is expected, and files.
std::string BashCompletion(const CLI::App& app, const std::vector<std::string>& posts);

}  // namespace patchmill::cli
