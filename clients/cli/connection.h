// The service that a command calls, on another machine or inside this process; and how a call ends early.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <absl/status/status.h>
#include <absl/status/statusor.h>
#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>
#include <grpcpp/support/status.h>

#include "clients/cli/interrupt_watch.h"
#include "server/server.h"

namespace patchmill::cli {

struct CommonOptions {
  std::string server;  // HOST:PORT; empty: inside this process
  std::string ca_file, cert_file, key_file;
  std::string token;              // sent as a bearer token; empty: none
  std::string request_id;         // the name of the call in the log of the server; empty: none
  int threads = 0;                // 0: all
  std::optional<double> timeout;  // s
  bool quiet = false;
};

// A channel, and the embedded server that it belongs to, if any. Both live equally long.
struct Connection {
  std::unique_ptr<RunningServer> embedded;
  std::shared_ptr<grpc::Channel> channel;
};
// Whether the server inside this process keeps models that are uploaded. They take memory.
enum class KeepModels { kNo, kYes };
// INVALID_ARGUMENT for wrong options; also where a token would be sent beyond this machine without TLS.
absl::StatusOr<Connection> Connect(const CommonOptions& options, KeepModels keep = KeepModels::kNo);

// The token in a file: its first line. INVALID_ARGUMENT with the reason where there is none.
absl::StatusOr<std::string> ReadTokenFile(const std::string& path);

// The context of a call. It has the token, the name and the deadline, and an interrupt cancels it while this
// object lives. It has to end before results are written.
class CallScope {
 public:
  CallScope(const CommonOptions& options, InterruptWatch& watch);
  ~CallScope() { watch_.Detach(); }
  grpc::ClientContext* context() { return &context_; }

 private:
  InterruptWatch& watch_;
  grpc::ClientContext context_;
};

// The error worded for a user. Field paths are replaced by the names of options where there is one.
absl::Status FromGrpc(const grpc::Status& status, const CommonOptions& options, const InterruptWatch& watch);

// The reason in the details of an error; empty without details.
std::string ReasonOf(const grpc::Status& status);

// A call that ends without an answer of its own, by its cause.
enum class Loss {
  kNone,         // it has an answer, or an error that another try would have, too
  kUnreachable,  // no server answers: the call has not begun
  kDraining,     // the server ends, and has not begun the call
  kBroken,       // the server, a proxy or the connection ended while the call ran
};
Loss LossOf(const grpc::Status& status);

// 0 for OK; 2 for wrong usage and unreadable input; 1 for any other error.
int ExitStatus(const absl::Status& status);

// Whether one message of the wire can have so many bytes.
bool FitsMessage(std::size_t bytes);
// INVALID_ARGUMENT if it cannot.
absl::Status CheckRequestSize(std::size_t bytes);

}  // namespace patchmill::cli
