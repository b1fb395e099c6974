// Lets one command line serve several commands: what only another command uses is accepted without effect.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace patchmill::cli {

// Adds to `command` the options of `other` that it does not have. They take the same number of values, have
// no effect, and `--help` does not list them.
void AcceptOptionsOf(const CLI::App& other, CLI::App& command);

// The options on the command line of `command` that have no effect: those of another command, and those of
// pictures in 3-D where none is written. "--feed", in the order of their definition.
std::vector<std::string> GivenWithoutEffect(const CLI::App& command);

}  // namespace patchmill::cli
