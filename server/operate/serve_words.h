// Options of a server that come from its environment or from a file: each flag has all three forms.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

namespace patchmill {

// An option as the command line knows it.
struct ServeOption {
  std::string name;      // without the dashes: "max-jobs"
  bool is_flag = false;  // it takes no value: "insecure"
};

struct ServeWords {
  std::vector<std::string> words;             // of the command line, the others behind them
  std::map<std::string, std::string> origin;  // of the others: "--max-jobs" -> "PATCHMILLD_MAX_JOBS"
};

// "max-jobs" -> "PATCHMILLD_MAX_JOBS".
std::string EnvironmentName(const std::string& option);

// Adds to the words of a command line what the variables PATCHMILLD_... and the file of --config say. The
// command line goes before the environment, the environment before the file. The file has lines
// "max-jobs = 4" and "insecure = true", and comments with #. INVALID_ARGUMENT with variable or line for an
// option that is not there, an empty value, and a flag that is neither true nor false. `environment` is
// environ(7).
absl::StatusOr<ServeWords> CollectServeWords(std::vector<std::string> words,
                                             const std::vector<ServeOption>& options,
                                             const std::vector<std::string>& environment);

}  // namespace patchmill
