// Groups the options of a command for `--help`: part, tool, finish and so on.
#pragma once

#include <CLI/CLI.hpp>

namespace patchmill::cli {

// Gives a program, and all commands that are added to it afterwards, a help that lists options in groups,
// with plain names of values, wrapped to the width of the terminal.
void FormatHelp(CLI::App& app);

// Gives each option of the command its group (part, tool, finish, ...). Options of no group stay under
// "Options", which comes first.
void GroupOptions(CLI::App& command);

}  // namespace patchmill::cli
