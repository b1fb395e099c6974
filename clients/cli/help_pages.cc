#include "clients/cli/help_pages.h"

#include <vector>

#include <absl/strings/str_join.h>
#include <absl/strings/str_replace.h>
#include <fmt/format.h>

namespace patchmill::cli {
namespace {

std::vector<const CLI::App*> Commands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App*) { return true; });
}

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

// The words of "TEXT:{auto,contour,zigzag}"; empty if the values are not words of a list.
std::vector<std::string> ChoicesOf(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t open = type.find('{'), close = type.find('}');
  if (open == type.npos || close == type.npos || close < open) return {};
  return CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
}

std::string CommandSection(const CLI::App& command) {
  std::string page = fmt::format(".SS {}\n{}\n", Roff(command.get_name()), Roff(command.get_description()));
  for (const CLI::Option* option : command.get_options()) {
    if (!IsListed(*option)) continue;
    page += fmt::format(".TP\n\\fB{}\\fR", Roff(NamesOf(*option)));
    if (option->get_items_expected_max() > 0)
      page += fmt::format(" \\fI{}\\fR", Roff(option->get_type_name()));
    page += "\n" + Roff(option->get_description());
    if (!option->get_default_str().empty())
      page += fmt::format(" (default {})", Roff(option->get_default_str()));
    page += "\n";
  }
  return page;
}

}  // namespace

std::string ManPage(const CLI::App& app, const std::string& version) {
  std::string page =
      fmt::format(".TH PATCHMILL 1 \"\" \"{}\" \"User Commands\"\n.SH NAME\n{}\n", Roff(version),
                  Roff(absl::StrReplaceAll(app.get_description(), {{"patchmill: ", "patchmill - "}})));
  page += ".SH SYNOPSIS\n.B patchmill\n\\fICOMMAND\\fR [\\fIOPTIONS\\fR] ...\n.SH COMMANDS\n";
  for (const CLI::App* command : Commands(app)) page += CommandSection(*command);
  page += fmt::format(".SH EXIT STATUS\n{}\n", Roff(app.get_footer()));
  return page;
}

std::string BashCompletion(const CLI::App& app) {
  std::vector<std::string> names;
  std::string options, choices;
  for (const CLI::App* command : Commands(app)) {
    names.push_back(command->get_name());
    std::vector<std::string> words;
    for (const CLI::Option* option : command->get_options()) {
      if (!IsListed(*option)) continue;
      for (const std::string& name : option->get_lnames()) {
        words.push_back("--" + name);
        const std::vector<std::string> values = ChoicesOf(*option);
        if (!values.empty())
          choices += fmt::format("    {}:--{}) words=\"{}\" ;;\n", command->get_name(), name,
                                 absl::StrJoin(values, " "));
      }
    }
    options += fmt::format("    {}) words=\"{}\" ;;\n", command->get_name(), absl::StrJoin(words, " "));
  }
  return fmt::format(R"(# Completion of patchmill for bash: source <(patchmill completion bash)
_patchmill() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD - 1]}} words=
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    COMPREPLY=($(compgen -W "{} --help --version --config" -- "$current"))
    return
  fi
  case "${{COMP_WORDS[1]}}:$previous" in
{}  esac
  if [ -n "$words" ]; then
    COMPREPLY=($(compgen -W "$words" -- "$current"))
    return
  fi
  case "$current" in
  -*) ;;
  *)
    local IFS=$'\n'
    COMPREPLY=($(compgen -f -- "$current"))
    return
    ;;
  esac
  case "${{COMP_WORDS[1]}}" in
{}  esac
  COMPREPLY=($(compgen -W "$words" -- "$current"))
}}
complete -o filenames -F _patchmill patchmill
)",
                     absl::StrJoin(names, " "), choices, options);
}

}  // namespace patchmill::cli
