// Options that say for which control a program is written, or was written.
#pragma once

#include <optional>
#include <string>

#include <CLI/CLI.hpp>
#include <absl/status/statusor.h>

namespace patchmill::cli {

struct PostOptions {
  std::string post = "linuxcnc";  // the name of a dialect, or a post file
  std::optional<double> control_deviation;
};

// `name` is the option's name: "--post" or "--dialect,--post".
void AddPostOptions(CLI::App& app, const std::string& name, PostOptions& options);

// The name of a dialect, or the text of a post file. The other one is empty.
struct ChosenPost {
  std::string dialect, post_file;
};

// An argument with a dot or a slash names a file. INVALID_ARGUMENT if it cannot be read.
absl::StatusOr<ChosenPost> ChoosePost(const PostOptions& options);

}  // namespace patchmill::cli
