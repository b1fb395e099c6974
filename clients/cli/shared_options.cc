#include "clients/cli/shared_options.h"

namespace patchmill::cli {
namespace {

constexpr char kWithoutEffect[] = "without effect";  // the description of such an option

}  // namespace

void AcceptOptionsOf(const CLI::App& other, CLI::App& command) {
  for (const CLI::Option* option : other.get_options()) {
    for (const std::string& name : option->get_lnames()) {
      if (command.get_option_no_throw("--" + name) != nullptr) continue;
      std::string names = "--" + name;
      for (const std::string& letter : option->get_snames()) {
        if (command.get_option_no_throw("-" + letter) == nullptr) names = "-" + letter + "," + names;
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
  std::vector<std::string> given;
  for (const CLI::Option* option : command.get_options()) {
    if (option->count() > 0 && option->get_description() == kWithoutEffect)
      given.push_back("--" + option->get_lnames().front());
  }
  return given;
}

}  // namespace patchmill::cli
