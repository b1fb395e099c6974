// Groups the options of a command for `--help`: part, tool, finish and so on.
#pragma once

#include <CLI/CLI.hpp>

namespace patchmill::cli {

// Gives each option of the command its group (part, tool, finish, ...), and the command a help that lists the
// groups in this order. Options of no group stay under "Options", which comes first.
void GroupOptions(CLI::App& command);

}  // namespace patchmill::cli
