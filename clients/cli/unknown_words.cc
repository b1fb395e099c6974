#include "clients/cli/unknown_words.h"

#include <vector>

#include <fmt/format.h>

#include "clients/cli/text.h"
#include "proto/json/nearest_word.h"

namespace patchmill::cli {
namespace {

std::vector<std::string> CommandNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

std::vector<std::string> OptionNames(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames())
      if (!option->get_group().empty()) names.push_back("--" + name);
  }
  return names;
}

std::string Unknown(const std::string& word, const std::string& what, const std::vector<std::string>& known) {
  const std::string near = NearestWord(word, known);
  return fmt::format("{} is no {}{}\n", Printable(word), what,
                     near.empty() ? "" : fmt::format("; did you mean {}?", near));
}

}  // namespace

std::string UnknownWords(const CLI::App& app) {
  std::string lines;
  const std::vector<const CLI::App*> given =
      app.get_subcommands([](const CLI::App* c) { return c->parsed(); });
  for (const CLI::App* command : given) {
    bool of_unknown = false;  // the word may be the value of an option that does not exist
    for (const std::string& word : command->remaining()) {
      const std::string name = word.substr(0, word.find('='));
      if (name.size() > 1 && name.front() == '-') {
        lines += Unknown(name, fmt::format("option of {}", command->get_name()), OptionNames(*command));
        of_unknown = true;
      } else if (!of_unknown) {
        lines += fmt::format("{}: {} was not expected\n", command->get_name(), Printable(word));
      }
    }
  }
  if (!given.empty()) return lines;
  const std::vector<std::string> words = app.remaining();
  return words.empty() ? "" : Unknown(words.front(), "command", CommandNames(app));
}

}  // namespace patchmill::cli
