// The service that a command calls, on another machine or inside this process; and how a call ends early.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <absl/status/status.h>
#include <absl/status/statusor.h>
#include <grpcpp/channel.h>
#include <grpcpp/client_context.h>
#include <grpcpp/support/status.h>

#include "server/server.h"

namespace patchmill::cli {

struct CommonOptions {
  std::string server;  // HOST:PORT; empty: inside this process
  std::string ca_file, cert_file, key_file;
  int threads = 0;                // 0: all
  std::optional<double> timeout;  // s
  bool quiet = false;
};

// A channel, and the embedded server that it belongs to, if any. Both live equally long.
struct Connection {
  std::unique_ptr<RunningServer> embedded;
  std::shared_ptr<grpc::Channel> channel;
};
absl::StatusOr<Connection> Connect(const CommonOptions& options);

// SIGINT and SIGTERM cancel the call instead of killing the process, so that no unfinished file is left. The
// constructor blocks both signals: make this object before any other thread.
class InterruptWatch {
 public:
  InterruptWatch();
  ~InterruptWatch();
  void Attach(grpc::ClientContext* context);  // the call to cancel; lives until Detach
  void Detach() { Attach(nullptr); }
  bool interrupted() const { return interrupted_.load(); }

 private:
  std::mutex mutex_;
  grpc::ClientContext* context_ = nullptr;
  std::atomic<bool> interrupted_{false}, stop_{false};
  std::thread thread_;
};

// The context of a call. It has the deadline, and an interrupt cancels it while this object lives.
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

// 0 for OK; 2 for wrong usage and unreadable input; 1 for any other error.
int ExitStatus(const absl::Status& status);

// INVALID_ARGUMENT if a request is too large for the wire.
absl::Status CheckRequestSize(std::size_t bytes);

}  // namespace patchmill::cli
