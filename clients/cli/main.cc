// patchmill: the command line.
#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "clients/cli/commands.h"
#include "clients/cli/completion.h"
#include "clients/cli/default_file.h"
#include "clients/cli/help_pages.h"
#include "clients/cli/option_groups.h"
#include "clients/cli/posts.h"
#include "clients/cli/shared_options.h"
#include "clients/cli/text.h"
#include "clients/cli/usage_fault.h"
#include "server/serve_flags.h"
#include "server/server.h"

namespace patchmill::cli {
namespace {

constexpr char kVersion[] = "patchmill " PATCHMILL_VERSION;
constexpr char kExitStatus[] =
    "Exit status:\n"
    "  0  the command is done\n"
    "  1  the job could not be done, or a verification failed\n"
    "  2  the usage is wrong, or the input is unreadable";

// A command of the command line: how it is called, what it does, and a call of it.
struct CommandEntry {
  const char* name;
  const char* help;
  const char* example;
  Command (*add)(CLI::App&);
};

constexpr CommandEntry kEntries[] = {
    {"mill", "plan, write and verify a program",
     "mill part.step -o part.ngc --tool-diameter 6 --scallop 0.01", AddMill},
    {"check", "check a model: patches, joints, curvature against the tool",
     "check part.step --tool-diameter 6", AddCheck},
    {"faces", "list the faces of a CAD file: ids, names, kinds, sizes", "faces part.step", AddFaces},
    {"convert", "write a model of any format, CAD files too, as a .pb or .json file",
     "convert part.step part.json", AddConvert},
    {"regions", "split the surface into regions: steep and gentle, mountain and basin, unreachable",
     "regions part.step -o regions.svg --tool-diameter 6", AddRegions},
    {"reach", "how much of the surface each of several balls does not reach",
     "reach part.step --tool-diameters 2,4,6,10", AddReach},
    {"verify", "measure any program against the exact surface",
     "verify part.step part.ngc --tool-diameter 6 --scallop 0.01 --dialect fanuc", AddVerify},
    {"posts", "list the dialects of programs, or print the post file of one", "posts fanuc > shop.post",
     AddPosts},
    {"capabilities", "what a server can do: dialects, formats, limits, quotas of this caller",
     "capabilities --server cam.example:50051 --ca ca.pem --token-file shop.token", AddCapabilities},
    {"lines", "trace contours, silhouettes, highlights and other lines of the surface",
     "lines part.step --kind contour --spacing 2 -o contours.svg", AddLines},
    {"evaluate", "points, derivatives, fundamental forms and curvatures of the surface",
     "evaluate part.step --at 0,0.5,0.5", AddEvaluate},
    {"build", "make a first surface from sections or boundary curves", "build sections.json -o skin.json",
     AddBuild},
    {"edit", "edit a curve network", "edit sheet.json -o pushed.json --edits edges.json", AddEdit},
    {"fair", "fair a measured curve or net of points", "fair wing.dat -o faired.dat --preview wing.svg",
     AddFair},
};

// --help and --version are no errors.
int UsageError(const CLI::App& app, const CLI::ParseError& error, const Arguments& arguments) {
  if (error.get_exit_code() == 0) return app.exit(error);
  fmt::print(stderr, "{}", UsageFault(app, error));
  for (const std::string& option : arguments.of_file) {
    if (std::string(error.what()).rfind(option + ":", 0) == 0)
      fmt::print(stderr, "{} comes from --config {}.\n", option, Printable(arguments.file));
  }
  return 2;
}

// `patchmill serve`: its options come from other places, too, and are those of patchmilld.
int RunServe(CLI::App& serve, const ServerOptions& server, std::vector<std::string> words) {
  constexpr char kProgram[] = "patchmill serve";
  const std::optional<ServeWords> all = ServeArguments(serve, kProgram, std::move(words));
  if (!all) return 2;
  try {
    serve.parse(std::vector<std::string>(all->words.rbegin(), all->words.rend()));  // the last one first
  } catch (const CLI::ParseError& error) {
    return ServeUsageError(serve, kProgram, error, *all);
  }
  return Serve(server);
}

int Main(int argc, char** argv) {
  CLI::App app("patchmill: verified ball-end-mill programs from free-form patch models", "patchmill");
  FormatHelp(app);
  app.set_help_flag("-h,--help", "print this help");
  app.set_version_flag("--version",
                       std::string(kVersion) +
                           "\nSTEP and IGES are read by patchmill-import, which uses Open CASCADE Technology",
                       "print the version");
  app.require_subcommand(1);
  app.footer(kExitStatus);
  std::string config;  // taken from the arguments before they are parsed; here for --help
  app.add_option(
      "--config", config,
      "file with a shop's defaults: lines \"spindle = 8000\", for one command below a line \"[mill]\"");
  std::map<CLI::App*, Command> commands;
  std::map<std::string, CLI::App*> of_name;
  for (const CommandEntry& entry : kEntries) {
    CLI::App* command = app.add_subcommand(entry.name, entry.help);
    commands[command] = entry.add(*command);
    of_name[entry.name] = command;
    GroupOptions(*command);
    command->footer(fmt::format("Example:\n  patchmill {}\n\n{}", entry.example, kExitStatus));
  }
  for (const char* name : {"regions", "reach", "verify"}) AcceptOptionsOf(*of_name["mill"], *of_name[name]);
  CLI::App* serve = app.add_subcommand("serve", "run the service (also as patchmilld)");
  ServerOptions server;
  std::string serve_config;
  AddServeFlags(*serve, server, serve_config);
  serve->formatter(std::make_shared<CLI::Formatter>());  // its options have groups of their own
  CLI::App* completion =
      app.add_subcommand("completion", "print a script that completes commands and options");
  std::string shell = "bash";
  completion->add_option("SHELL", shell, "the shell")->check(CLI::IsMember({"bash"}))->capture_default_str();
  CLI::App* man = app.add_subcommand("man", "print the manual page, for man -l -");

  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    command->group("Commands");

  if (argc > 1 && std::string_view(argv[1]) == "serve")
    return RunServe(*serve, server, {argv + 2, argv + argc});
  const absl::StatusOr<Arguments> arguments = WithDefaults(app, {argv + 1, argv + argc});
  if (!arguments.ok()) {
    fmt::print(stderr, "patchmill: {}\n", std::string(arguments.status().message()));
    return 2;
  }
  try {
    app.parse(std::vector<std::string>(arguments->words.rbegin(),
                                       arguments->words.rend()));  // CLI11 takes the last one first
  } catch (const CLI::ParseError& error) {
    return UsageError(app, error, *arguments);
  }
  if (serve->parsed()) return Serve(server);
  if (man->parsed()) {
    fmt::print("{}", ManPage(app, kVersion));
    return 0;
  }
  InterruptWatch watch;
  if (completion->parsed()) {
    const absl::StatusOr<std::vector<std::string>> posts = PostNames(CommonOptions(), watch);
    if (posts.ok()) fmt::print("{}", BashCompletion(app, *posts));
    return ExitStatus(posts.status());
  }
  for (const auto& [command, run] : commands) {
    if (!command->parsed()) continue;
    std::vector<std::string> idle = GivenWithoutEffect(*command);
    // Defaults of a shop are for all commands.
    std::erase_if(idle, [&](const std::string& option) {
      return std::find(arguments->of_file.begin(), arguments->of_file.end(), option) !=
             arguments->of_file.end();
    });
    if (!idle.empty())
      fmt::print(stderr, "patchmill {}: without effect: {}\n", command->get_name(), fmt::join(idle, " "));
    const absl::Status status = run(watch);
    if (!status.ok()) fmt::print(stderr, "patchmill: {}\n", std::string(status.message()));
    return ExitStatus(status);
  }
  return 2;
}

}  // namespace
}  // namespace patchmill::cli

int main(int argc, char** argv) { return patchmill::cli::Main(argc, argv); }
