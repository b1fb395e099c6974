// The service as a running thing: started in a process or on a port, drained, asked for its health.
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
  virtual ~RunningServer() = default;  // cuts off what still runs
  // A channel into this very process; no port is involved.
  virtual std::shared_ptr<grpc::Channel> InProcessChannel() = 0;
  // The port it listens on, 0 for an embedded server.
  virtual int port() const = 0;
  // Answers NOT_SERVING, takes no new jobs, lets running ones end, and after `seconds` cuts them off.
  virtual void Drain(double seconds) = 0;
};

// Listens on options.listen. INVALID_ARGUMENT for a bad address, for unreadable TLS files, and for an address
// beyond loopback with neither TLS nor options.insecure.
absl::StatusOr<std::unique_ptr<RunningServer>> StartServer(const ServerOptions& options);

// Serves this process only.
std::unique_ptr<RunningServer> StartEmbeddedServer(ServerOptions options);

// Runs a server until SIGTERM or SIGINT, then drains it. Returns the exit status: 0, or 2 when it cannot
// start.
int Serve(const ServerOptions& options);

// Asks the server at `target` (HOST:PORT) for its health, over TLS when `options` names certificates: 0 when
// it serves, 1 otherwise, with a word on stderr.
int CheckHealth(const std::string& target, const ServerOptions& options);

}  // namespace patchmill
