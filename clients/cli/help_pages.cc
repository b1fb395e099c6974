#include "clients/cli/help_pages.h"

#include <vector>

#include <absl/strings/str_join.h>
#include <absl/strings/str_replace.h>
#include <absl/strings/str_split.h>
#include <fmt/format.h>

#include "clients/cli/option_value.h"

namespace patchmill::cli {
namespace {

// No character of the text is taken for a macro or an escape.
std::string Roff(const std::string& text) {
  std::string safe = absl::StrReplaceAll(text, {{"\\", "\\e"}, {"-", "\\-"}, {"\n", " "}});
  if (!safe.empty() && (safe.front() == '.' || safe.front() == '\'')) safe = "\\&" + safe;
  return safe;
}

// "-o, --output", or the name of a positional argument.
std::string NamesOf(const CLI::Option& option) {
  if (option.get_positional() && option.get_lnames().empty()) return option.get_name();
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return absl::StrJoin(names, ", ");
}

bool IsListed(const CLI::Option& option) { return !option.get_group().empty(); }

std::string CommandSection(const CLI::App& command) {
  std::string page = fmt::format(".SS {}\n{}\n", Roff(command.get_name()), Roff(command.get_description()));
  for (const CLI::Option* option : command.get_options()) {
    if (!IsListed(*option)) continue;
    page += fmt::format(".TP\n\\fB{}\\fR", Roff(NamesOf(*option)));
    if (const std::string value = ValueName(*option); !value.empty())
      page += fmt::format(" \\fI{}\\fR", Roff(value));
    page += "\n" + Roff(DescriptionOf(*option)) + "\n";
  }
  return page;
}

}  // namespace

std::string ManPage(const CLI::App& app, const std::string& version) {
  std::string page =
      fmt::format(".TH PATCHMILL 1 \"\" \"{}\" \"User Commands\"\n.SH NAME\n{}\n", Roff(version),
                  Roff(absl::StrReplaceAll(app.get_description(), {{"patchmill: ", "patchmill - "}})));
  page += ".SH SYNOPSIS\n.B patchmill\n\\fICOMMAND\\fR [\\fIOPTIONS\\fR] ...\n.SH COMMANDS\n";
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    page += CommandSection(*command);
  page += ".SH EXIT STATUS\n";
  const std::vector<std::string> lines = absl::StrSplit(app.get_footer(), '\n');
  for (std::size_t k = 1; k < lines.size(); ++k) page += Roff(lines[k]) + "\n.br\n";  // below the title
  return page;
}

}  // namespace patchmill::cli
