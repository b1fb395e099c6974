#include "clients/cli/option_value.h"

#include <algorithm>
#include <regex>

#include <absl/strings/str_join.h>
#include <absl/strings/str_replace.h>
#include <fmt/format.h>

namespace patchmill::cli {
namespace {

constexpr const char* kFiles[] = {"output",  "report", "preview", "tolerance-map", "ca",
                                  "cert",    "key",    "config",  "machine",       "regions",
                                  "network", "edits",  "patches", "polyline"};
constexpr const char* kAddresses[] = {"server", "listen"};

template <std::size_t N>
bool IsOneOf(const CLI::Option& option, const char* const (&names)[N]) {
  return std::any_of(std::begin(names), std::end(names),
                     [&](const char* name) { return option.check_lname(name); });
}

// "0 to 64" of "INT:INT in [0 - 64]"; empty for other types.
std::string RangeOf(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  std::smatch range;
  return std::regex_search(type, range, std::regex(" in \\[(\\S+) - (\\S+)\\]"))
             ? fmt::format("{} to {}", range[1].str(), range[2].str())
             : "";
}

std::string Names(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options) names.push_back(option->get_name());
  std::sort(names.begin(), names.end());
  return absl::StrJoin(names, " and ");
}

}  // namespace

std::vector<std::string> ChoicesOf(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t open = type.find('{'), close = type.find('}');
  if (open == type.npos || close == type.npos || close < open) return {};
  return CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
}

bool TakesNumber(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return type.rfind("FLOAT", 0) == 0 || type.rfind("INT", 0) == 0 || type.rfind("UINT", 0) == 0;
}

std::string ValueName(const CLI::Option& option) {
  if (option.get_items_expected_max() == 0 || option.get_positional()) return "";
  const std::vector<std::string> choices = ChoicesOf(option);
  const std::string name = !choices.empty()              ? absl::StrJoin(choices, "|")
                           : IsOneOf(option, kFiles)     ? "FILE"
                           : IsOneOf(option, kAddresses) ? "HOST:PORT"
                           : !TakesNumber(option)        ? "TEXT"
                           : option.get_expected_max() == 3 || option.get_type_size_max() == 3 ? "X,Y,Z"
                                                                                               : "NUMBER";
  return option.get_expected_max() >= CLI::detail::expected_max_vector_size ? name + "..." : name;
}

std::string DescriptionOf(const CLI::Option& option) {
  std::string text = absl::StrReplaceAll(option.get_description(), {{"\n", " "}});
  if (const std::string range = RangeOf(option); !range.empty()) text += "; " + range;
  if (!option.get_default_str().empty())  // lists stand in brackets there
    text += "; default " + absl::StrReplaceAll(option.get_default_str(), {{"[", ""}, {"]", ""}});
  if (option.get_required() && !option.get_positional()) text += "; required";
  if (!option.get_needs().empty()) text += "; needs " + Names(option.get_needs());
  if (!option.get_excludes().empty()) text += "; not with " + Names(option.get_excludes());
  return text;
}

}  // namespace patchmill::cli
