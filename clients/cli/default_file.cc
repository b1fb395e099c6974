#include "clients/cli/default_file.h"

#include <algorithm>
#include <optional>
#include <sstream>
#include <string_view>

#include <absl/strings/ascii.h>
#include <absl/strings/str_split.h>
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
  const bool listed = option != nullptr && !option->get_group().empty() && option != command.get_help_ptr();
  return listed ? option : nullptr;
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
    if (argument.size() < 2 || argument.front() != '-') return false;
    if (argument[1] != '-') {  // "-o" or "-oFILE"
      const std::vector<std::string>& letters = option.get_snames();
      return std::find(letters.begin(), letters.end(), argument.substr(1, 1)) != letters.end();
    }
    return option.check_name(argument.substr(0, argument.find('=')));
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
    for (const CLI::Option* option : command->get_options()) {
      for (const std::string& name : option->get_lnames())
        if (ListedOption(*command, name) != nullptr) options.push_back(name);
    }
  }
  if (!item.parents.empty() && std::find(names.begin(), names.end(), item.parents.front()) == names.end())
    return Fault(
        path, fmt::format("[{}] is no command; sections are named as commands", Printable(item.fullname())));
  if (known) return absl::OkStatus();
  const std::string near = NearestWord(item.name, options);
  return Fault(path, fmt::format("{} is no option{}", Printable(item.fullname()),
                                 near.empty() ? "" : fmt::format("; did you mean {}?", near)));
}

// Each line is a section, an option with its value, a comment or empty. The reader of CLI11 passes over
// whatever is none of these.
absl::Status CheckLines(const std::string& path, const std::string& text) {
  int number = 0;
  for (const absl::string_view piece : absl::StrSplit(text, '\n')) {
    ++number;
    const std::string line(absl::StripAsciiWhitespace(piece));
    if (line.empty() || line.front() == '#' || line.front() == ';') continue;
    const std::size_t equals = line.find('=');
    const bool is_section = line.front() == '[' && line.back() == ']' && line.size() > 2;
    const bool is_option =
        line.front() != '[' && equals != line.npos && equals > 0 && equals + 1 < line.size();
    if (!is_section && !is_option) {
      return Fault(path, fmt::format("line {}: \"{}\"; must be NAME = VALUE, [COMMAND] or # COMMENT", number,
                                     Printable(WireText(line, 60))));
    }
    const std::string value(absl::StripAsciiWhitespace(line.substr(equals + 1)));
    if (is_option && value.front() == '"' && (value.size() == 1 || value.find('"', 1) == value.npos))
      return Fault(path,
                   fmt::format("line {}: {} has no closing quote", number, Printable(WireText(value, 60))));
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<Arguments> WithDefaults(const CLI::App& app, std::vector<std::string> arguments) {
  absl::StatusOr<std::optional<std::string>> path = TakePath(arguments);
  if (!path.ok()) return path.status();
  if (!*path) return Arguments{.words = std::move(arguments), .file = {}, .of_file = {}};
  const absl::StatusOr<std::string> text = ReadWholeFile(**path);
  if (!text.ok()) return text.status();
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  const std::string lines = text->compare(0, 3, kByteOrderMark) == 0 ? text->substr(3) : *text;
  if (const absl::Status good = CheckLines(**path, lines); !good.ok()) return good;
  std::istringstream in(lines);
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
  // Options of the section of the command go before those above all sections.
  std::stable_partition(items.begin(), items.end(),
                        [](const CLI::ConfigItem& item) { return !item.parents.empty(); });
  std::vector<std::string> more, names;
  for (const CLI::ConfigItem& item : items) {
    if (item.name == "++" || item.name == "--") continue;  // the reader's marks of sections
    if (item.parents.size() > 1)
      return Fault(**path, fmt::format("{}: sections have no parts", Printable(item.fullname())));
    if (const absl::Status known = CheckItem(app, **path, item); !known.ok()) return known;
    if (chosen == nullptr || (!item.parents.empty() && item.parents.front() != chosen->get_name())) continue;
    const CLI::Option* const option = ListedOption(*chosen, item.name);
    if (option == nullptr || IsGiven(arguments, *option) || IsGiven(more, *option)) continue;
    // A tool of the command line brings its own values.
    const CLI::Option* const tool = chosen->get_option_no_throw("--tool");
    if (tool != nullptr && option->get_group() == tool->get_group() && IsGiven(arguments, *tool)) continue;
    names.push_back("--" + item.name);
    if (option->get_items_expected_max() == 0) {
      const std::string value = item.inputs.empty() ? "true" : item.inputs.front();
      const bool on = value == "true" || value == "yes" || value == "1";
      if (!on && value != "false" && value != "no" && value != "0")
        return Fault(**path, fmt::format("{} = {}; must be true or false", item.name, Printable(value)));
      if (on) more.push_back("--" + item.name);
      continue;
    }
    const int most = option->get_items_expected_max();
    if (static_cast<int>(item.inputs.size()) > most && !option->get_allow_extra_args()) {
      return Fault(
          **path,
          fmt::format("{} has {} values, and takes {}; a value with blanks or commas stands in quotes",
                      item.name, item.inputs.size(), most));
    }
    more.push_back("--" + item.name);
    more.insert(more.end(), item.inputs.begin(), item.inputs.end());
  }
  arguments.insert(arguments.end(), more.begin(), more.end());
  return Arguments{.words = std::move(arguments), .file = **path, .of_file = std::move(names)};
}

}  // namespace patchmill::cli
