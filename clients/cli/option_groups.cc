#include "clients/cli/option_groups.h"

#include <memory>
#include <string>
#include <vector>

namespace patchmill::cli {
namespace {

struct Group {
  const char* title;
  std::vector<std::string> options;
};

const std::vector<Group>& Groups() {
  static const auto* const groups = new std::vector<Group>{
      {"Part",
       {"length-unit", "up", "scale", "translate", "zero", "border-tolerance", "skip-face", "wall-side"}},
      {"Tool",
       {"tool", "tool-diameter", "tool-diameters", "flute-length", "shank-diameter", "stickout", "holder",
        "holder-clearance", "tool-number", "feed", "plunge-feed", "spindle", "coolant"}},
      {"Finish",
       {"scallop", "tolerance", "leave", "no-finish", "strategy", "steep-angle", "detail", "zigzag-angle",
        "bend", "auto-angle", "one-way", "spirals", "no-round-lines", "no-border-passes", "edges",
        "direction", "region", "regions", "max-unreached"}},
      {"Stock and limits",
       {"stock", "stock-top", "allowance", "accept-depth", "only", "avoid", "avoid-margin", "boundary",
        "boundary-mode", "boundary-offset", "outside", "top", "floor", "obstacle", "machine",
        "machine-z-safe"}},
      {"Motion",
       {"clearance", "approach-gap", "high-rapids", "low-rapids", "lead-radius", "lead-sweep", "lead-feed",
        "link-feed", "keep-feed", "plunge-angle"}},
      {"Program",
       {"post", "dialect", "work-offset", "control-deviation", "no-arcs", "inch", "restart-points",
        "line-numbers", "program-number", "assume"}},
      {"Output",
       {"output", "report", "preview", "picture-view", "picture-shading", "picture-layers", "picture-size",
        "tolerance-map", "all-findings"}},
      {"Service", {"server", "ca", "cert", "key", "threads", "timeout", "quiet", "config"}}};
  return *groups;
}

class GroupedHelp : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    if (mode == CLI::AppFormatMode::Sub) return CLI::Formatter::make_help(app, name, mode);
    return make_description(app) + make_usage(app, name) + make_positionals(app) + Options(*app) + "\n" +
           make_footer(app);
  }

 private:
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

void GroupOptions(CLI::App& command) {
  const auto help = std::make_shared<GroupedHelp>();
  help->column_width(command.get_formatter()->get_column_width());
  command.formatter(help);
  for (const Group& group : Groups()) {
    for (const std::string& name : group.options) {
      if (CLI::Option* const option = command.get_option_no_throw("--" + name)) option->group(group.title);
    }
  }
}

}  // namespace patchmill::cli
