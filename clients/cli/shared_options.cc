#include "clients/cli/shared_options.h"

#include <absl/strings/match.h>
#include <absl/strings/str_cat.h>

namespace patchmill::cli {
namespace {

constexpr char kWithoutEffect[] = "without effect";  // the description of such an option

// Whether one of the files that a command writes is a picture in 3-D.
bool WritesPicture(const CLI::App& command) {
  for (const char* name : {"--output", "--preview"}) {
    const CLI::Option* const option = command.get_option_no_throw(name);
    if (option == nullptr) continue;
    for (const std::string& file : option->results())
      if (absl::EndsWithIgnoreCase(file, ".png")) return true;
  }
  return false;
}

}  // namespace

void AcceptOptionsOf(const CLI::App& other, CLI::App& command) {
  for (const CLI::Option* option : other.get_options()) {
    for (const std::string& name : option->get_lnames()) {
      if (command.get_option_no_throw("--" + name) != nullptr) continue;
      std::string names = "--" + name;
      for (const std::string& letter : option->get_snames()) {
        if (command.get_option_no_throw("-" + letter) == nullptr)
          names = absl::StrCat("-", letter, ",", names);
      }
      if (option->get_items_expected_max() == 0) {
        command.add_flag(names)->description(kWithoutEffect)->group("");
        continue;
      }
      command
          .add_option_function<std::vector<std::string>>(
              names, [](const std::vector<std::string>&) {}, kWithoutEffect)
          ->type_size(option->get_type_size_min(), option->get_type_size_max())
          ->expected(option->get_expected_min(), option->get_expected_max())
          ->delimiter(option->get_delimiter())
          ->allow_extra_args(option->get_allow_extra_args())
          ->group("");
    }
  }
}

std::vector<std::string> GivenWithoutEffect(const CLI::App& command) {
  const bool has_picture = WritesPicture(command);
  std::vector<std::string> given;
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() == 0 || option->get_lnames().empty()) continue;
    const std::string& name = option->get_lnames().front();
    if (option->get_description() == kWithoutEffect || (!has_picture && absl::StartsWith(name, "picture-")))
      given.push_back("--" + name);
  }
  return given;
}

}  // namespace patchmill::cli
