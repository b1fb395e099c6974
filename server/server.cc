#include "server/server.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <grpcpp/grpcpp.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include "core/base/keep_memory.h"
#include "core/base/status.h"
#include "server/errors.h"
#include "server/health_service.h"
#include "server/limits.h"
#include "server/listener.h"
#include "server/lower_priority.h"
#include "server/reflection_service.h"
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
  // Without a listener the server serves its own process only.
  GrpcServer(const ServerOptions& options, std::unique_ptr<Listener> listener,
             const std::shared_ptr<grpc::ServerCredentials>& credentials,
             std::unique_ptr<DiskCache> disk = nullptr)
      : listener_(std::move(listener)),
        env_(options, MeterOf(listener_.get()), std::move(disk)),
        services_(MakeServices(&env_)),
        health_(env_.in_flight, options.max_write_seconds),
        reflection_(MakeReflectionService(Names(), env_.in_flight, options.max_write_seconds)) {
    grpc::ServerBuilder builder;
    // Messages above the limit are refused by the services, whose errors have details.
    builder.SetMaxReceiveMessageSize(
        static_cast<int>(limits::kMaxMessageBytes + limits::kMaxMessageBytes / 4));
    builder.SetMaxSendMessageSize(static_cast<int>(limits::kMaxMessageBytes));
    builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, limits::kMaxCallsPerConnection);
    builder.AddChannelArgument(GRPC_ARG_SERVER_HANDSHAKE_TIMEOUT_MS, 1000 * limits::kHandshakeSeconds);
    // Behind proxies and address translation clients ping, also while they wait for a job without progress.
    builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS,
                               1000 * limits::kClientPingSeconds);
    builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_PERMIT_WITHOUT_CALLS, 1);
    builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, 1000 * limits::kPingSeconds);
    builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 1000 * limits::kPingAnswerSeconds);
    builder.AddChannelArgument(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
    builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_AGE_MS, 3'600'000 * limits::kConnectionHours);
    // gRPC decompresses a message before it checks the size. The result may be a thousand times as large.
    for (const auto packed : {GRPC_COMPRESS_DEFLATE, GRPC_COMPRESS_GZIP}) {
      builder.SetCompressionAlgorithmSupportStatus(packed, false);
    }
    std::shared_ptr<grpc::experimental::ExternalConnectionAcceptor> acceptor;
    if (listener_) {
      builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_IDLE_MS,
                                 static_cast<int>(1000.0 * options.max_idle_seconds));
      acceptor = builder.experimental().AddExternalConnectionAcceptor(
          grpc::ServerBuilder::experimental_type::ExternalConnectionType::FROM_FD, credentials);
    }
    for (const NamedService& service : services_) builder.RegisterService(service.service.get());
    builder.RegisterService(health_.service());
    builder.RegisterService(reflection_.get());
    server_ = builder.BuildAndStart();
    if (!started()) return;
    SetServing(true);
    if (!listener_) return;
    port_ = listener_->port();
    listener_->Start([acceptor](int listening, int socket) {
      grpc::experimental::ExternalConnectionAcceptor::NewConnectionParameters connection;
      connection.listener_fd = listening;
      connection.fd = socket;
      acceptor->HandleNewConnection(&connection);
    });
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
    // The port stays open: whoever asks learns that the server drains, and a new call gets the reason.
    SetServing(false);
    env_.quick.Drain();
    env_.jobs.Drain();
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (Busy() && std::chrono::steady_clock::now() < end)
      std::this_thread::sleep_for(std::chrono::milliseconds(limits::kCancelPollMs));
    env_.stopped.store(true);
    env_.running.StopAll(DrainingError());
    const auto last = std::chrono::steady_clock::now() + std::chrono::milliseconds(limits::kAbandonMs);
    while (Busy() && std::chrono::steady_clock::now() < last)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    if (listener_) listener_->Stop();
    server_->Shutdown(std::chrono::system_clock::now() +
                      std::chrono::duration_cast<std::chrono::system_clock::duration>(
                          std::max(last - std::chrono::steady_clock::now(), std::chrono::nanoseconds(0))));
    server_->Wait();
  }

 private:
  // Calls run, wait, or have not read their answer yet.
  bool Busy() const { return env_.calls.load() > 0; }

  void SetServing(bool serving) {
    health_.SetServing("", serving);
    for (const NamedService& service : services_) health_.SetServing(service.name, serving);
  }

  std::vector<std::string> Names() const {
    std::vector<std::string> names;
    for (const NamedService& service : services_) names.emplace_back(service.name);
    return names;
  }

  static ReceivedBytes MeterOf(Listener* listener) {
    if (listener == nullptr) return {};
    return [listener](const std::string& peer) { return listener->ReceivedBytes(peer); };
  }

  std::unique_ptr<Listener> listener_;
  ServerEnv env_;
  std::vector<NamedService> services_;
  HealthService health_;
  std::unique_ptr<SmallService> reflection_;
  std::unique_ptr<grpc::Server> server_;
  int port_ = 0;
  bool drained_ = false;
};

// Without TLS anybody on the way can read the traffic, and anybody who reaches the port can call the
// service.
absl::Status CheckEncrypted(const ServerOptions& options, const std::vector<SocketAddress>& addresses) {
  const bool loopback = std::all_of(addresses.begin(), addresses.end(), IsLoopback);
  if (loopback || options.insecure || !options.cert_file.empty()) return absl::OkStatus();
  return absl::InvalidArgumentError(
      fmt::format("--listen {} opens the service to the network without TLS: set --cert and --key "
                  "(PEM files; with --ca only its clients may call), or --insecure if the network is trusted",
                  options.listen));
}

absl::StatusOr<std::unique_ptr<DiskCache>> OpenCache(const ServerOptions& options) {
  if (options.cache_dir.empty()) return std::unique_ptr<DiskCache>();
  const std::chrono::duration<double> lifetime(86400.0 * options.cache_days);
  return DiskCache::Open({options.cache_dir, std::int64_t{options.cache_mib} << 20,
                          std::chrono::duration_cast<std::chrono::seconds>(lifetime)});
}

}  // namespace

absl::StatusOr<std::unique_ptr<RunningServer>> StartServer(const ServerOptions& options) {
  PM_ASSIGN_OR_RETURN(const std::vector<SocketAddress> addresses, ResolveListenAddress(options.listen));
  PM_ASSIGN_OR_RETURN(const auto credentials, Credentials(options));
  PM_RETURN_IF_ERROR(CheckEncrypted(options, addresses));
  PM_ASSIGN_OR_RETURN(auto listener, Listener::Bind(addresses, options.listen, RaiseConnectionLimit()));
  PM_ASSIGN_OR_RETURN(std::unique_ptr<DiskCache> disk, OpenCache(options));
  auto server = std::make_unique<GrpcServer>(options, std::move(listener), credentials, std::move(disk));
  if (!server->started()) return absl::InternalError("gRPC does not start");
  return server;
}

std::unique_ptr<RunningServer> StartEmbeddedServer(ServerOptions options) {
  options.log_requests = false;
  auto server = std::make_unique<GrpcServer>(options, nullptr, nullptr);
  PM_CHECK(server->started());
  return server;
}

int Serve(const ServerOptions& options) {
  KeepFreedMemory();
  // The signals are blocked before any thread starts, so that only the wait below receives them.
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::signal(SIGXFSZ, SIG_IGN);  // a file of the cache that grows beyond its limit is an error of write

  LowerPriorityOfWorkers();
  spdlog::set_default_logger(spdlog::stderr_logger_mt("patchmill"));
  ServerOptions served = options;
  served.lower_priority_of_jobs = true;
  absl::StatusOr<std::unique_ptr<RunningServer>> server = StartServer(served);
  if (!server.ok()) {
    fmt::print(stderr, "patchmill: {}\n", std::string(server.status().message()));
    return 2;
  }
  spdlog::info("patchmill {} listens on {}, port {}", ServerVersion(), options.listen, (*server)->port());
  int signal = 0;
  sigwait(&signals, &signal);
  spdlog::info("signal {}: draining for at most {} s", signal, options.drain_seconds);
  (*server)->Drain(options.drain_seconds);
  spdlog::info("stopped");
  return 0;
}

}  // namespace patchmill
