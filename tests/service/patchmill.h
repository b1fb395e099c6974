// Runs the command line as a user does.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tests/service/process.h"

namespace patchmill::testing {

// Runs `patchmill` with these arguments.
inline Finished Patchmill(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), PATCHMILL_BIN "/patchmill");
  return Run(arguments);
}

// The command lines of all commands that take a model, with results in `dir`. mill stands before verify,
// which reads its program. Tolerance and scallop are in mm.
inline std::vector<std::vector<std::string>> CommandsOn(const std::string& model, const TempDir& dir,
                                                        const std::string& tolerance,
                                                        const std::string& scallop) {
  const std::vector<std::string> finish = {"--scallop", scallop, "--tolerance", tolerance};
  const auto with_finish = [&finish](std::vector<std::string> command) {
    command.insert(command.end(), finish.begin(), finish.end());
    return command;
  };
  return {{"check", model},
          {"faces", model},
          with_finish({"regions", model}),
          {"reach", model, "--tool-diameters", "2,6"},
          {"lines", model, "-o", dir / "lines.json"},
          {"evaluate", model, "--at", "0,0.5,0.5"},
          with_finish({"mill", model, "-o", dir / "part.ngc"}),
          with_finish({"verify", model, dir / "part.ngc", "--tool-diameter", "6"})};
}

}  // namespace patchmill::testing
