// A shop's defaults: options in a file (`--config FILE`) that a command line need not repeat.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <absl/status/statusor.h>

namespace patchmill::cli {

// The words of a command line, those of the file behind them.
struct Arguments {
  std::vector<std::string> words;
  std::string file;                  // empty without --config
  std::vector<std::string> of_file;  // options that come from the file: "--spindle"
};

// The arguments (without the name of the program) with the options of the file that --config names behind
// them. The file has lines "spindle = 8000", "coolant = flood", "high-rapids = true", "# a comment". What
// stands above the first section counts for every command that has such an option, what stands below
// "[mill]" for that command. An option that the command line gives goes before the file. Without --config
// the arguments stay as they are. INVALID_ARGUMENT for a file that cannot be read, with the line where it
// is one, and for an option or a section that no command has.
absl::StatusOr<Arguments> WithDefaults(const CLI::App& app, std::vector<std::string> arguments);

}  // namespace patchmill::cli
