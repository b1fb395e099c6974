// Starts the service in a process or on a port, drains it, and checks its health.
#pragma once

#include <memory>
#include <string>

#include <absl/status/statusor.h>

#include "server/options.h"

namespace grpc {
class Channel;
}  // namespace grpc

namespace patchmill {

class RunningServer {
 public:
  virtual ~RunningServer() = default;  // ends the calls that still run
  // A channel within this process, without a port.
  virtual std::shared_ptr<grpc::Channel> InProcessChannel() = 0;
  // The port that the server listens on; 0 for an embedded server.
  virtual int port() const = 0;
  // Reads the files of callers and certificates again soon.
  virtual void Reload() = 0;
  // Answers NOT_SERVING and takes no new jobs. Running jobs may end; after `seconds` they are cancelled.
  virtual void Drain(double seconds) = 0;
};

// Starts a server that listens on options.listen. INVALID_ARGUMENT for a bad address, for unreadable TLS
// files, and for an address beyond loopback with neither TLS nor options.insecure.
absl::StatusOr<std::unique_ptr<RunningServer>> StartServer(const ServerOptions& options);

// Starts a server for this process only.
std::unique_ptr<RunningServer> StartEmbeddedServer(ServerOptions options);

// Runs a server until SIGTERM or SIGINT, then drains it. SIGHUP reads the files of callers and certificates
// again. Returns the exit status: 0, or 2 if the server cannot start.
int Serve(const ServerOptions& options);

// Asks the server at `target` (HOST:PORT, or HOST:PORT/SERVICE) for its health, over TLS if `options` names
// certificates. Returns 0 if it serves, else 1 with a message on stderr.
int CheckHealth(const std::string& target, const ServerOptions& options);

}  // namespace patchmill
