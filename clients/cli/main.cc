// patchmill: the command line.
#include <cstdio>
#include <map>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "clients/cli/commands.h"
#include "server/serve_flags.h"
#include "server/server.h"

namespace patchmill::cli {
namespace {

int Main(int argc, char** argv) {
  CLI::App app("patchmill: verified ball-end-mill programs from free-form patch models");
  app.set_version_flag("--version",
                       "patchmill " PATCHMILL_VERSION
                       "\nSTEP and IGES are read by patchmill-import, which uses Open CASCADE Technology");
  app.require_subcommand(1);
  app.footer(
      "Exit status: 0 the command is done; 1 the job could not be done, or a verification failed; 2 the "
      "usage "
      "is wrong, or the input is unreadable.");
  std::map<CLI::App*, Command> commands;
  const auto add = [&](const char* name, const char* help, Command (*add_command)(CLI::App&)) {
    CLI::App* command = app.add_subcommand(name, help);
    commands[command] = add_command(*command);
  };
  add("mill", "plan, write and verify a program", AddMill);
  add("check", "check a model: patches, joints, curvature against the tool", AddCheck);
  add("faces", "list the faces of a CAD file: ids, names, kinds, sizes", AddFaces);
  add("convert", "write a model of any format, CAD files too, as a .pb or .json file", AddConvert);
  add("regions", "split the surface into regions: steep and gentle, mountain and basin, unreachable",
      AddRegions);
  add("reach", "how much of the surface each of several balls does not reach", AddReach);
  add("verify", "measure any program against the exact surface", AddVerify);
  add("posts", "list the dialects of programs, or print the post file of one", AddPosts);
  add("lines", "trace contours, silhouettes, highlights and other lines of the surface", AddLines);
  add("evaluate", "points, derivatives, fundamental forms and curvatures of the surface", AddEvaluate);
  add("build", "make a first surface from sections or boundary curves", AddBuild);
  add("edit", "edit a curve network", AddEdit);
  add("fair", "fair a measured curve or net of points", AddFair);
  CLI::App* serve = app.add_subcommand("serve", "run the service (also as patchmilld)");
  ServerOptions server;
  AddServeFlags(*serve, server);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  if (serve->parsed()) return Serve(server);
  InterruptWatch watch;
  for (const auto& [command, run] : commands) {
    if (!command->parsed()) continue;
    const absl::Status status = run(watch);
    if (!status.ok()) fmt::print(stderr, "patchmill: {}\n", std::string(status.message()));
    return ExitStatus(status);
  }
  return 2;
}

}  // namespace
}  // namespace patchmill::cli

int main(int argc, char** argv) { return patchmill::cli::Main(argc, argv); }
