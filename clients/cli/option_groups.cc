#include "clients/cli/option_groups.h"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <absl/strings/str_split.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "clients/cli/option_value.h"

namespace patchmill::cli {
namespace {

struct Group {
  const char* title;
  std::vector<std::string> options;
};

const std::vector<Group>& Groups() {
  static const auto* const groups = new std::vector<Group>{
      {"Part",
       {"length-unit", "up", "scale", "translate", "zero", "border-tolerance", "skip-face", "cap-holes",
        "wall-side"}},
      {"Tool",
       {"tool", "tool-diameter", "tool-diameters", "flute-length", "shank-diameter", "stickout", "holder",
        "holder-clearance", "tool-number", "feed", "plunge-feed", "spindle", "coolant"}},
      {"Finish",
       {"scallop", "tolerance", "leave", "no-finish", "strategy", "steep-angle", "detail", "zigzag-angle",
        "bend", "auto-angle", "one-way", "spirals", "no-round-lines", "no-border-passes", "edges",
        "direction", "region", "regions", "max-unreached"}},
      {"Stock and limits",
       {"stock", "stock-top", "allowance", "allowance-walls", "allowance-floors", "accept-depth", "only",
        "avoid", "avoid-margin", "boundary", "boundary-mode", "boundary-offset", "outside", "top", "floor",
        "obstacle", "machine", "machine-z-safe"}},
      {"Motion",
       {"clearance", "approach-gap", "high-rapids", "low-rapids", "lead-radius", "lead-sweep", "lead-feed",
        "link-feed", "corner-feed", "keep-feed", "plunge-angle"}},
      {"Program",
       {"post", "dialect", "work-offset", "control-deviation", "no-arcs", "inch", "restart-points",
        "line-numbers", "program-number", "assume"}},
      {"Output",
       {"output", "report", "preview", "picture-view", "picture-shading", "picture-layers", "picture-size",
        "tolerance-map", "all-findings"}},
      {"Service", {"server", "ca", "cert", "key", "token-file", "threads", "timeout", "quiet", "config"}}};
  return *groups;
}

// Columns of the help: those of the terminal, within reason.
std::size_t HelpColumns() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 100;
  return std::clamp<std::size_t>(size.ws_col, 72, 120);
}

// Breaks text into lines between its words. All lines but the first are indented.
std::string Wrapped(const std::string& text, std::size_t indent, std::size_t columns) {
  std::string wrapped;
  std::size_t column = indent;
  for (const std::string& word : std::vector<std::string>(absl::StrSplit(text, ' ', absl::SkipEmpty()))) {
    if (column > indent && column + 1 + word.size() > columns) {
      wrapped += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (column > indent) {
      wrapped += ' ';
      ++column;
    }
    wrapped += word;
    column += word.size();
  }
  return wrapped;
}

class GroupedHelp : public CLI::Formatter {
 public:
  GroupedHelp() {
    column_width(kIndent);
    label("SUBCOMMAND", "COMMAND");
  }

  std::string make_option(const CLI::Option* option, bool is_positional) const override {
    const std::string value = ValueName(*option);
    std::string line = "  " + make_option_name(option, is_positional) + (value.empty() ? "" : " " + value);
    line += line.size() + 2 > kIndent ? "\n" + std::string(kIndent, ' ')
                                      : std::string(kIndent - line.size(), ' ');
    return line + Wrapped(DescriptionOf(*option), kIndent, HelpColumns()) + "\n";
  }

  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    if (mode == CLI::AppFormatMode::Sub) return CLI::Formatter::make_help(app, name, mode);
    return make_description(app) + make_usage(app, name) + make_positionals(app) + Options(*app) +
           make_subcommands(app, mode) + "\n" + make_footer(app);
  }

 private:
  static constexpr std::size_t kIndent = 28;  // of descriptions

  std::string Options(const CLI::App& app) const {
    std::vector<std::string> titles = {"Options"};
    for (const Group& group : Groups()) titles.emplace_back(group.title);
    std::string text;
    for (const std::string& title : titles) {
      const std::vector<const CLI::Option*> options = app.get_options(
          [&](const CLI::Option* option) { return option->get_group() == title && option->nonpositional(); });
      if (!options.empty()) text += make_group(title, false, options);
    }
    return text;
  }
};

}  // namespace

void FormatHelp(CLI::App& app) { app.formatter(std::make_shared<GroupedHelp>()); }

void GroupOptions(CLI::App& command) {
  for (const Group& group : Groups()) {
    for (const std::string& name : group.options) {
      if (CLI::Option* const option = command.get_option_no_throw("--" + name)) option->group(group.title);
    }
  }
}

}  // namespace patchmill::cli
