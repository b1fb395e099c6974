// One function per command. It adds the options of the command and returns the function that runs it after
// parsing.
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

#include "clients/cli/connection.h"

namespace patchmill::cli {

// Runs a parsed command. Its status decides the exit status; the message of the status goes to stderr.
using Command = std::function<absl::Status(InterruptWatch&)>;

Command AddMill(CLI::App& app);
Command AddCheck(CLI::App& app);
Command AddFaces(CLI::App& app);
Command AddConvert(CLI::App& app);
Command AddRegions(CLI::App& app);
Command AddReach(CLI::App& app);
Command AddVerify(CLI::App& app);
Command AddPosts(CLI::App& app);
Command AddCapabilities(CLI::App& app);
Command AddBuild(CLI::App& app);
Command AddEdit(CLI::App& app);
Command AddFair(CLI::App& app);
Command AddLines(CLI::App& app);
Command AddEvaluate(CLI::App& app);

}  // namespace patchmill::cli
