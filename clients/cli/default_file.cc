#include "clients/cli/default_file.h"

#include <algorithm>
#include <optional>
#include <sstream>

#include <fmt/format.h>

#include "clients/cli/input_file.h"
#include "clients/cli/text.h"
#include "proto/json/nearest_word.h"

namespace patchmill::cli {
namespace {

constexpr char kOption[] = "--config";

std::vector<const CLI::App*> Commands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

const CLI::Option* ListedOption(const CLI::App& command, const std::string& name) {
  const CLI::Option* const option = command.get_option_no_throw("--" + name);
  return option != nullptr && !option->get_group().empty() ? option : nullptr;
}

// Takes `--config FILE` or `--config=FILE` out of the arguments. INVALID_ARGUMENT if the file is missing,
// or given twice.
absl::StatusOr<std::optional<std::string>> TakePath(std::vector<std::string>& arguments) {
  std::optional<std::string> path;
  const std::string prefix = std::string(kOption) + "=";
  for (std::size_t k = 0; k < arguments.size();) {
    const bool joined = arguments[k].compare(0, prefix.size(), prefix) == 0;
    if (!joined && arguments[k] != kOption) {
      ++k;
      continue;
    }
    if (path) return absl::InvalidArgumentError("--config is given twice");
    if (!joined && k + 1 == arguments.size()) return absl::InvalidArgumentError("--config needs a file");
    path = joined ? arguments[k].substr(prefix.size()) : arguments[k + 1];
    const auto begin = arguments.begin() + static_cast<std::ptrdiff_t>(k);
    arguments.erase(begin, begin + (joined ? 1 : 2));
  }
  return path;
}

bool IsGiven(const std::vector<std::string>& arguments, const CLI::Option& option) {
  return std::any_of(arguments.begin(), arguments.end(), [&](const std::string& argument) {
    const std::string name = argument.substr(0, argument.find('='));
    return option.check_name(name) && name.front() == '-';
  });
}

absl::Status Fault(const std::string& path, const std::string& message) {
  return absl::InvalidArgumentError(fmt::format("--config {}: {}", path, message));
}

// The section and the option must exist, in that command or, without a section, in any.
absl::Status CheckItem(const CLI::App& app, const std::string& path, const CLI::ConfigItem& item) {
  std::vector<std::string> names, options;
  bool known = false;
  for (const CLI::App* command : Commands(app)) {
    names.push_back(command->get_name());
    if (!item.parents.empty() && item.parents.front() != command->get_name()) continue;
    known = known || ListedOption(*command, item.name) != nullptr;
    for (const CLI::Option* option : command->get_options())
      for (const std::string& name : option->get_lnames()) options.push_back(name);
  }
  if (!item.parents.empty() && std::find(names.begin(), names.end(), item.parents.front()) == names.end())
    return Fault(
        path, fmt::format("[{}] is no command; sections are named as commands", Printable(item.fullname())));
  if (known) return absl::OkStatus();
  const std::string near = NearestWord(item.name, options);
  return Fault(path, fmt::format("{} is no option{}", Printable(item.fullname()),
                                 near.empty() ? "" : fmt::format("; did you mean {}?", near)));
}

}  // namespace

absl::StatusOr<std::vector<std::string>> WithDefaults(const CLI::App& app,
                                                      std::vector<std::string> arguments) {
  absl::StatusOr<std::optional<std::string>> path = TakePath(arguments);
  if (!path.ok()) return path.status();
  if (!*path) return arguments;
  const absl::StatusOr<std::string> text = ReadWholeFile(**path);
  if (!text.ok()) return text.status();
  std::istringstream in(*text);
  std::vector<CLI::ConfigItem> items;
  try {
    items = CLI::ConfigTOML().from_config(in);
  } catch (const CLI::Error& error) {
    return Fault(**path, error.what());
  }
  const CLI::App* chosen = nullptr;
  for (const CLI::App* command : Commands(app)) {
    if (!arguments.empty() && arguments.front() == command->get_name()) chosen = command;
  }
  std::vector<std::string> more;
  for (const CLI::ConfigItem& item : items) {
    if (item.name == "++" || item.name == "--") continue;  // the reader's marks of sections
    if (const absl::Status known = CheckItem(app, **path, item); !known.ok()) return known;
    if (chosen == nullptr || (!item.parents.empty() && item.parents.front() != chosen->get_name())) continue;
    const CLI::Option* const option = ListedOption(*chosen, item.name);
    if (option == nullptr || IsGiven(arguments, *option) || IsGiven(more, *option)) continue;
    if (option->get_items_expected_max() == 0) {
      const bool on = item.inputs.empty() || item.inputs.front() == "true";
      if (!on && item.inputs.front() != "false")
        return Fault(
            **path, fmt::format("{} = {}; must be true or false", item.name, Printable(item.inputs.front())));
      if (on) more.push_back("--" + item.name);
      continue;
    }
    more.push_back("--" + item.name);
    more.insert(more.end(), item.inputs.begin(), item.inputs.end());
  }
  // Behind the last argument a list of values would take the model for one of them.
  if (!arguments.empty()) arguments.insert(arguments.begin() + 1, more.begin(), more.end());
  return arguments;
}

}  // namespace patchmill::cli
