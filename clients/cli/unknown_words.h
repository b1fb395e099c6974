// Names what somebody may have meant by a word of the command line that no command or option has.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace patchmill::cli {

// "mil is no command; did you mean mill?", a line for each word that was not expected; empty if all were.
std::string UnknownWords(const CLI::App& app);

}  // namespace patchmill::cli
