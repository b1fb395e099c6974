#include "clients/cli/usage_fault.h"

#include <regex>
#include <vector>

#include <absl/strings/str_join.h>
#include <fmt/format.h>

#include "clients/cli/text.h"
#include "clients/cli/unknown_words.h"
#include "proto/json/nearest_word.h"

namespace patchmill::cli {
namespace {

constexpr std::size_t kMostBytes = 1000;  // of a report: std::regex takes stack for each byte

// The command that was given; the whole program where there is none.
const CLI::App& Given(const CLI::App& app) {
  const std::vector<const CLI::App*> given =
      app.get_subcommands([](const CLI::App* command) { return command->parsed(); });
  return given.empty() ? app : *given.front();
}

std::string MissingCommand(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return "a command is missing; there are " + absl::StrJoin(names, ", ");
}

// The example of the help of a command: the second line of its footer.
std::string Example(const CLI::App& command) {
  const std::string footer = command.get_footer();
  std::smatch example;
  return std::regex_search(footer, example, std::regex("^Example:\n *(.*)\n"))
             ? "\n  for example: " + example[1].str()
             : "";
}

std::string OneOf(const std::string& name, const std::string& value, const std::string& list) {
  const std::vector<std::string> words = CLI::detail::split(list, ',');
  const std::string near = NearestWord(value, words);
  return fmt::format("{} {}; must be {}{}", name, value,
                     words.size() == 1 ? words.front() : "one of " + absl::StrJoin(words, ", "),
                     near.empty() ? "" : fmt::format("; did you mean {}?", near));
}

std::string Values(const std::string& number) { return number == "1" ? "a value" : number + " values"; }

// "0.5" for "0.500000".
std::string ShortNumber(const std::string& number) {
  return std::regex_replace(number, std::regex("\\.0+$|(\\.\\d*[1-9])0+$"), "$1");
}

// What CLI11 reports, as a sentence about the option and its values.
std::string InPlainWords(const CLI::App& app, const CLI::App& command, const std::string& report) {
  std::smatch part;
  const auto is = [&](const char* form) { return std::regex_match(report, part, std::regex(form)); };
  if (report == "A subcommand is required") return MissingCommand(app);
  if (is("(\\S+) is required")) return fmt::format("{} is missing{}", part[1].str(), Example(command));
  if (is("(\\S+): (\\d+) required \\S+ missing"))
    return fmt::format("{} needs {}", part[1].str(), Values(part[2].str()));
  if (is("(\\S+): At Most 1 required but received (\\d+)"))
    return fmt::format("{} is given {} times; give it once", part[1].str(), part[2].str());
  if (is("(\\S+): At (Most|least) (\\d+) required but received (\\d+)"))
    return fmt::format("{} has {}; must have {}", part[1].str(), Values(part[4].str()), part[3].str());
  if (is("(\\S+): ([^]*) not in \\{(.*)\\}")) return OneOf(part[1].str(), part[2].str(), part[3].str());
  if (is("(\\S+): Value ([^]*) not in range (\\S+) to (\\S+)"))
    return fmt::format("{} {}; must be in [{}, {}]", part[1].str(), part[2].str(), ShortNumber(part[3].str()),
                       ShortNumber(part[4].str()));
  if (is("(\\S+) excludes (\\S+)"))
    return fmt::format("{} and {} exclude each other; give one of them", part[1].str(), part[2].str());
  return report;
}

}  // namespace

std::string UsageFault(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& command = Given(app);
  const std::string name = &command == &app ? "patchmill" : "patchmill " + command.get_name();
  std::string fault = UnknownWords(app);
  if (fault.empty()) {
    const std::string report = Printable(std::string(error.what()).substr(0, kMostBytes));
    fault = fmt::format("{}: {}\n", name, InPlainWords(app, command, report));
  }
  return fmt::format("{}'{} --help' lists what there is.\n", fault, name);
}

}  // namespace patchmill::cli
