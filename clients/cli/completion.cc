#include "clients/cli/completion.h"

#include <absl/strings/str_join.h>
#include <absl/strings/str_replace.h>
#include <fmt/format.h>

#include "clients/cli/option_value.h"

namespace patchmill::cli {
namespace {

bool IsListed(const CLI::Option& option) { return !option.get_group().empty(); }

// Whether a value may be the name of a post: --post, --dialect, and the argument of `posts`.
bool TakesPost(const CLI::App& command, const CLI::Option& option) {
  return option.check_lname("post") || option.check_lname("dialect") ||
         (command.get_name() == "posts" && option.get_positional());
}

// The cases of the script, by command and option; "COMMAND:" is its argument.
struct Cases {
  std::string options;  // of each command
  std::string words;    // values that are words of a list
  std::string posts;    // values that are names of posts, or post files
  std::string numbers;  // values that nobody can complete
};

std::string Names(const std::vector<std::string>& cases) {
  return cases.empty() ? "none" : absl::StrJoin(cases, "|");
}

Cases MakeCases(const CLI::App& app) {
  Cases cases;
  std::vector<std::string> posts, numbers;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command->get_options()) {
      if (!IsListed(*option)) continue;
      std::vector<std::string> here;
      for (const std::string& name : option->get_lnames()) here.push_back("--" + name);
      names.insert(names.end(), here.begin(), here.end());
      for (const std::string& name : option->get_snames()) here.push_back("-" + name);
      if (option->get_positional()) here.emplace_back();
      if (option->get_items_expected_max() == 0) continue;
      const std::vector<std::string> choices = ChoicesOf(*option);
      for (const std::string& name : here) {
        const std::string key = command->get_name() + ":" + name;
        if (!choices.empty()) {
          cases.words += fmt::format("  {}) words=\"{}\" ;;\n", key, absl::StrJoin(choices, " "));
        } else if (TakesPost(*command, *option)) {
          posts.push_back(key);
        } else if (TakesNumber(*option)) {
          numbers.push_back(key);
        }
      }
    }
    cases.options += fmt::format("  {}) words=\"{}\" ;;\n", command->get_name(), absl::StrJoin(names, " "));
  }
  cases.posts = Names(posts);
  cases.numbers = Names(numbers);
  return cases;
}

// Names between @ are replaced. Where COMPREPLY stays empty, bash completes file names itself, and quotes
// those with blanks.
constexpr char kScript[] = R"(# Completion of patchmill for bash: source <(patchmill completion bash)
_patchmill() {
  local current=${COMP_WORDS[COMP_CWORD]} option=${COMP_WORDS[COMP_CWORD - 1]} command= words= is_post= i file
  COMPREPLY=()
  # bash cuts --post=fanuc into three words.
  if [ "$current" = = ]; then
    current=
  elif [ "$option" = = ]; then
    option=${COMP_WORDS[COMP_CWORD - 2]}
  fi
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case "${COMP_WORDS[i]}" in
    --config) [ "${COMP_WORDS[i + 1]}" = = ] && ((i += 2)) || ((i += 1)) ;;
    @COMMANDS@)
      command=${COMP_WORDS[i]}
      break
      ;;
    esac
  done
  [ "$option" = --config ] && return
  if [ -z "$command" ]; then
    COMPREPLY=($(compgen -W "@NAMES@ --help --version --config" -- "$current"))
    return
  fi
  case "$command:$option" in
  @NUMBERS@)
    compopt +o default 2>/dev/null
    return
    ;;
  @POSTS@) words="@POST_NAMES@" is_post=1 ;;
@WORDS@  *)
    case "$option" in
    -*) ;;
    *)
      case "$command:" in
      @POSTS@) words="@POST_NAMES@" is_post=1 ;;
@WORDS@      esac
      ;;
    esac
    ;;
  esac
  if [[ $current = -* ]]; then
    case "$command" in
@OPTIONS@    esac
    COMPREPLY=($(compgen -W "$words" -- "$current"))
    return
  fi
  [ -z "$words" ] && return
  COMPREPLY=($(compgen -W "$words" -- "$current"))
  # A post file is named with a dot or a slash.
  if [ -n "$is_post" ] && [ ${#COMPREPLY[@]} -gt 0 ]; then
    while IFS= read -r file; do
      case "$file" in
      */* | *.*) COMPREPLY+=("$file") ;;
      *) COMPREPLY+=("./$file") ;;
      esac
    done < <(compgen -f -- "${current//\\/}")
  fi
}
complete -o default -o filenames -F _patchmill patchmill
)";

}  // namespace

std::string BashCompletion(const CLI::App& app, const std::vector<std::string>& posts) {
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    commands.push_back(command->get_name());
  const Cases cases = MakeCases(app);
  return absl::StrReplaceAll(kScript, {{"@COMMANDS@", absl::StrJoin(commands, "|")},
                                       {"@NAMES@", absl::StrJoin(commands, " ")},
                                       {"@NUMBERS@", cases.numbers},
                                       {"@POSTS@", cases.posts},
                                       {"@POST_NAMES@", absl::StrJoin(posts, " ")},
                                       {"@WORDS@", cases.words},
                                       {"@OPTIONS@", cases.options}});
}

}  // namespace patchmill::cli
