#include "clients/cli/post_options.h"

#include <fmt/format.h>

#include "clients/cli/input_file.h"
#include "clients/cli/job_options.h"
#include "clients/cli/text.h"

namespace patchmill::cli {

void AddPostOptions(CLI::App& app, const std::string& name, PostOptions& options) {
  app.add_option(name, options.post,
                 "dialect of the program, one of those that 'patchmill posts' lists, or a post file "
                 "(./shop.post)")
      ->capture_default_str();
  AddNumber(app, "--control-deviation", options.control_deviation,
            "by how much the control leaves the path, mm, for dialects without a word that states it; "
            "default: exact stop");
}

absl::StatusOr<ChosenPost> ChoosePost(const PostOptions& options) {
  if (options.post.find_first_of("./\\") == std::string::npos)
    return ChosenPost{.dialect = WireText(options.post, 100), .post_file = {}};
  absl::StatusOr<std::string> text = ReadWholeFile(options.post);
  if (!text.ok()) return text.status();
  if (text->empty()) return absl::InvalidArgumentError(fmt::format("{} is empty", options.post));
  for (char& c : *text) {
    if (static_cast<unsigned char>(c) >= 0x80) c = '\x01';  // the server names the line
  }
  return ChosenPost{.dialect = {}, .post_file = *std::move(text)};
}

}  // namespace patchmill::cli
