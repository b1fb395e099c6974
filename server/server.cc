#include "server/server.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/grpcpp.h>
#include <grpcpp/health_check_service_interface.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include "core/base/keep_memory.h"
#include "core/base/status.h"
#include "server/limits.h"
#include "server/services.h"
#include "server/tls_files.h"

namespace patchmill {
namespace {

absl::StatusOr<std::shared_ptr<grpc::ServerCredentials>> Credentials(const ServerOptions& options) {
  if (options.cert_file.empty() && options.key_file.empty()) {
    if (!options.ca_file.empty()) return absl::InvalidArgumentError("--ca needs --cert and --key");
    return grpc::InsecureServerCredentials();
  }
  if (options.cert_file.empty() || options.key_file.empty()) {
    return absl::InvalidArgumentError("--cert and --key belong together");
  }
  grpc::SslServerCredentialsOptions ssl(options.ca_file.empty()
                                            ? GRPC_SSL_DONT_REQUEST_CLIENT_CERTIFICATE
                                            : GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY);
  PM_ASSIGN_OR_RETURN(std::string cert, ReadPemFile(options.cert_file));
  PM_ASSIGN_OR_RETURN(std::string key, ReadPemFile(options.key_file));
  ssl.pem_key_cert_pairs.push_back({std::move(key), std::move(cert)});
  if (!options.ca_file.empty()) {
    PM_ASSIGN_OR_RETURN(ssl.pem_root_certs, ReadPemFile(options.ca_file));
  }
  return grpc::SslServerCredentials(ssl);
}

class GrpcServer final : public RunningServer {
 public:
  GrpcServer(const ServerOptions& options, const std::shared_ptr<grpc::ServerCredentials>& credentials)
      : env_(options), services_(MakeServices(&env_)) {
    grpc::EnableDefaultHealthCheckService(true);
    grpc::reflection::InitProtoReflectionServerBuilderPlugin();
    grpc::ServerBuilder builder;
    builder.SetMaxReceiveMessageSize(static_cast<int>(limits::kMaxMessageBytes));
    builder.SetMaxSendMessageSize(static_cast<int>(limits::kMaxMessageBytes));
    // One server a port: a second one must fail, not share the load unseen.
    builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
    if (credentials) builder.AddListeningPort(options.listen, credentials, &port_);
    for (const NamedService& service : services_) builder.RegisterService(service.service.get());
    server_ = builder.BuildAndStart();
    // Per-service names answer NOT_FOUND until they are set.
    if (started()) SetServing(true);
  }
  ~GrpcServer() override { Drain(0.0); }

  bool started() const { return server_ != nullptr; }
  int port() const override { return port_; }

  std::shared_ptr<grpc::Channel> InProcessChannel() override {
    grpc::ChannelArguments arguments;
    arguments.SetMaxReceiveMessageSize(static_cast<int>(limits::kMaxMessageBytes));
    arguments.SetMaxSendMessageSize(static_cast<int>(limits::kMaxMessageBytes));
    return server_->InProcessChannel(arguments);
  }

  void Drain(double seconds) override {
    if (!server_ || drained_) return;
    drained_ = true;
    SetServing(false);
    env_.admission.Drain();
    server_->Shutdown(std::chrono::system_clock::now() +
                      std::chrono::milliseconds(static_cast<std::int64_t>(1000.0 * seconds)));
    server_->Wait();
  }

 private:
  void SetServing(bool serving) {
    grpc::HealthCheckServiceInterface* health = server_->GetHealthCheckService();
    if (health == nullptr) return;
    health->SetServingStatus(serving);
    for (const NamedService& service : services_) health->SetServingStatus(service.name, serving);
  }

  ServerEnv env_;
  std::vector<NamedService> services_;
  std::unique_ptr<grpc::Server> server_;
  int port_ = 0;
  bool drained_ = false;
};

// gRPC takes a port above 65535 for what is left of it by 65536, and 443 where there is none.
absl::Status CheckPort(std::string_view listen) {
  if (listen.substr(0, 4) == "unix") return absl::OkStatus();
  const std::size_t colon = listen.rfind(':');
  const std::string port(colon == std::string_view::npos ? "" : listen.substr(colon + 1));
  const bool digits = !port.empty() && port.size() <= 5 &&
                      std::all_of(port.begin(), port.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (digits && std::stoi(port) <= 65535) return absl::OkStatus();
  return absl::InvalidArgumentError(
      fmt::format("cannot listen on {}: must be HOST:PORT with a port of 0 to 65535", listen));
}

}  // namespace

absl::StatusOr<std::unique_ptr<RunningServer>> StartServer(const ServerOptions& options) {
  PM_RETURN_IF_ERROR(CheckPort(options.listen));
  PM_ASSIGN_OR_RETURN(const auto credentials, Credentials(options));
  auto server = std::make_unique<GrpcServer>(options, credentials);
  if (!server->started() || server->port() == 0) {
    return absl::InvalidArgumentError(fmt::format(
        "cannot listen on {}: not HOST:PORT, not an address of this machine, or taken", options.listen));
  }
  return server;
}

std::unique_ptr<RunningServer> StartEmbeddedServer(ServerOptions options) {
  options.log_requests = false;
  auto server = std::make_unique<GrpcServer>(options, nullptr);
  PM_CHECK(server->started());
  return server;
}

int Serve(const ServerOptions& options) {
  KeepFreedMemory();
  // Blocked before any thread starts, so that only the wait below sees them.
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);

  spdlog::set_default_logger(spdlog::stderr_logger_mt("patchmill"));
  absl::StatusOr<std::unique_ptr<RunningServer>> server = StartServer(options);
  if (!server.ok()) {
    fmt::print(stderr, "patchmill: {}\n", std::string(server.status().message()));
    return 2;
  }
  spdlog::info("patchmill {} listens on {}, port {}", ServerVersion(), options.listen, (*server)->port());
  int signal = 0;
  sigwait(&signals, &signal);
  spdlog::info("signal {}: draining for at most {} s", signal, limits::kDrainSeconds);
  (*server)->Drain(limits::kDrainSeconds);
  spdlog::info("stopped");
  return 0;
}

}  // namespace patchmill
