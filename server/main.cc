// patchmilld: the service.
#include <CLI/CLI.hpp>

#include "server/call.h"
#include "server/serve_flags.h"
#include "server/server.h"

int main(int argc, char** argv) {
  CLI::App app("patchmilld: verified ball-end-mill programs from free-form patch models, as a gRPC service");
  app.set_version_flag("--version", std::string("patchmilld ") + patchmill::ServerVersion());
  patchmill::ServerOptions options;
  patchmill::AddServeFlags(app, options);
  std::string ask;
  app.add_option("--check-health", ask,
                 "HOST:PORT: ask the server there for its health: status 0 serving, 1 not");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  if (ask.empty()) return patchmill::Serve(options);
  return patchmill::CheckHealth(ask, options);
}
