// patchmilld: the service.
#include <CLI/CLI.hpp>

#include "server/call.h"
#include "server/serve_flags.h"
#include "server/server.h"

int main(int argc, char** argv) {
  constexpr char kProgram[] = "patchmilld";
  CLI::App app("patchmilld: verified ball-end-mill programs from free-form patch models, as a gRPC service",
               kProgram);
  app.set_version_flag("--version", std::string("patchmilld ") + patchmill::ServerVersion());
  patchmill::ServerOptions options;
  std::string config;  // its options are taken from the file before the words are parsed
  patchmill::AddServeFlags(app, options, config);
  std::string ask;
  app.add_option(
      "--check-health", ask,
      "HOST:PORT, or HOST:PORT/liveness: ask the server there for its health: status 0 serving, 1 not");
  std::optional<patchmill::ServeWords> words =
      patchmill::ServeArguments(app, kProgram, {argv + 1, argv + argc});
  if (!words) return 2;
  try {
    app.parse(std::vector<std::string>(words->words.rbegin(), words->words.rend()));  // the last one first
  } catch (const CLI::ParseError& error) {
    return patchmill::ServeUsageError(app, kProgram, error, *words);
  }
  if (ask.empty()) return patchmill::Serve(options);
  return patchmill::CheckHealth(ask, options);
}
