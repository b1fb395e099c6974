#include "server/server.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <absl/time/time.h>
#include <fmt/format.h>
#include <grpc/support/log.h>
#include <grpcpp/grpcpp.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include "core/base/keep_memory.h"
#include "core/base/status.h"
#include "server/errors.h"
#include "server/health_service.h"
#include "server/limits.h"
#include "server/listener.h"
#include "server/lower_priority.h"
#include "server/operate/callers_file.h"
#include "server/operate/file_watch.h"
#include "server/operate/log.h"
#include "server/operate/process_counts.h"
#include "server/operate/tls_credentials.h"
#include "server/operate/tls_files.h"
#include "server/process_memory.h"
#include "server/reflection_service.h"
#include "server/services.h"

namespace patchmill {
namespace {

constexpr int kFileWatchMs = 500;  // files of callers and certificates are looked at this often

TlsPaths PathsOf(const ServerOptions& options) {
  return {options.cert_file, options.key_file, options.ca_file};
}

// Null without TLS.
absl::StatusOr<std::shared_ptr<TlsState>> ReadTls(const ServerOptions& options) {
  if (options.cert_file.empty() && options.key_file.empty()) {
    if (!options.ca_file.empty()) return absl::InvalidArgumentError("--ca needs --cert and --key");
    return std::shared_ptr<TlsState>();
  }
  if (options.cert_file.empty() || options.key_file.empty()) {
    return absl::InvalidArgumentError("--cert and --key belong together");
  }
  PM_ASSIGN_OR_RETURN(TlsFiles files, ReadTlsFiles(PathsOf(options)));
  return std::make_shared<TlsState>(std::move(files));
}

void LogCertificate(const TlsFiles& files) {
  Log(LogLevel::kInfo,
      fmt::format("the certificate is good until {}",
                  absl::FormatTime(absl::RFC3339_sec, absl::FromChrono(files.until), absl::UTCTimeZone())));
}

// The parts of a server that are made before it starts.
struct ServerParts {
  std::unique_ptr<Listener> listener;  // null: the server serves its own process only
  std::shared_ptr<TlsState> tls;       // null: no TLS
  std::unique_ptr<DiskCache> disk;     // may be null
  std::optional<CallerTable> callers;  // nothing: anybody may call
};

class GrpcServer final : public RunningServer {
 public:
  GrpcServer(const ServerOptions& options, ServerParts parts)
      : listener_(std::move(parts.listener)),
        tls_(parts.tls),
        env_(options, MeterOf(listener_.get()), std::move(parts.disk)),
        services_(MakeServices(&env_)),
        health_(env_.in_flight, SmallRules({})),
        reflection_(MakeReflectionService(
            Names(), env_.in_flight,
            SmallRules([this](const Presented& presented) { return env_.callers.Name(presented); }))) {
    if (parts.callers) env_.callers.Set(*std::move(parts.callers));
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
          grpc::ServerBuilder::experimental_type::ExternalConnectionType::FROM_FD,
          tls_ ? MakeTlsCredentials(tls_) : grpc::InsecureServerCredentials());
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
  ~GrpcServer() override {
    env_.metrics.Stop();
    Drain(0.0);
  }

  bool started() const { return server_ != nullptr; }
  int port() const override { return port_; }

  std::shared_ptr<grpc::Channel> InProcessChannel() override {
    grpc::ChannelArguments arguments;
    arguments.SetMaxReceiveMessageSize(static_cast<int>(limits::kMaxMessageBytes));
    arguments.SetMaxSendMessageSize(static_cast<int>(limits::kMaxMessageBytes));
    return server_->InProcessChannel(arguments);
  }

  void Reload() override {
    if (watch_) watch_->Poke();
  }

  // Reads the files of callers and certificates again whenever one has changed. A wrong file changes nothing.
  void WatchFiles() {
    const ServerOptions& options = env_.options;
    std::vector<std::string> paths;
    for (const std::string& path :
         {options.tokens_file, options.cert_file, options.key_file, options.ca_file}) {
      if (!path.empty()) paths.push_back(path);
    }
    if (paths.empty()) return;
    const auto read = [this] {
      ReadCallersAgain();
      ReadCertificatesAgain();
    };
    watch_ = std::make_unique<FileWatch>(std::move(paths), read, std::chrono::milliseconds(kFileWatchMs));
  }

  absl::StatusOr<int> ServeMetrics() {
    return env_.metrics.Serve(env_.options.metrics_listen, [this] { return Figures(); });
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
  // Of health and reflection, which are not logged.
  CallRules SmallRules(Admission admit) const {
    CallRules rules;
    rules.admit = std::move(admit);
    rules.write_seconds = env_.options.max_write_seconds;
    return rules;
  }

  // Calls run, wait, or have not read their answer yet.
  bool Busy() const { return env_.calls.load() > 0; }

  void ReadCallersAgain() {
    const std::string& path = env_.options.tokens_file;
    if (path.empty()) return;
    absl::StatusOr<CallerTable> table = ReadCallers(path, !env_.options.ca_file.empty());
    if (!table.ok()) {
      Log(LogLevel::kError,
          fmt::format("{}; the callers of before stay", std::string(table.status().message())));
      return;
    }
    Log(LogLevel::kInfo, fmt::format("read {}: {} callers", path, table->callers.size()));
    env_.callers.Set(*std::move(table));
  }

  void ReadCertificatesAgain() {
    if (!tls_) return;
    absl::StatusOr<TlsFiles> files = ReadTlsFiles(PathsOf(env_.options));
    if (!files.ok()) {
      Log(LogLevel::kError,
          fmt::format("{}; the certificates of before stay", std::string(files.status().message())));
      return;
    }
    LogCertificate(*files);
    tls_->Set(*std::move(files));
  }

  ServerFigures Figures() const {
    ServerFigures now;
    now.running_jobs = env_.jobs.running();
    now.waiting_jobs = env_.jobs.waiting();
    now.job_places = env_.jobs.places();
    now.running_quick_calls = env_.quick.running();
    now.waiting_quick_calls = env_.quick.waiting();
    now.open_calls = env_.calls.load();
    now.resident_bytes = static_cast<double>(ResidentBytes());
    now.memory_limit_bytes = static_cast<double>(env_.shares.limit);
    now.granted_bytes = static_cast<double>(env_.memory.taken());
    now.granted_limit_bytes = static_cast<double>(env_.memory.limit());
    const Store::Figures store = env_.store.figures();
    now.store_bytes = static_cast<double>(store.bytes);
    now.store_limit_bytes = static_cast<double>(store.limit_bytes);
    now.store_values = static_cast<double>(store.values);
    now.store_hits = static_cast<double>(store.found);
    now.store_misses = static_cast<double>(store.missed);
    now.store_forgotten = static_cast<double>(store.forgotten);
    now.draining = !env_.jobs.CheckOpen().ok();
    if (tls_)
      now.certificate_until = static_cast<double>(std::chrono::system_clock::to_time_t(tls_->files().until));
    return now;
  }

  void SetServing(bool serving) {
    health_.SetServing("", serving);
    health_.SetServing("readiness", serving);
    health_.SetServing("liveness", true);  // a server that drains is alive
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
  std::shared_ptr<TlsState> tls_;  // null: no TLS
  ServerEnv env_;
  std::vector<NamedService> services_;
  HealthService health_;
  std::unique_ptr<SmallService> reflection_;
  std::unique_ptr<FileWatch> watch_;
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

// A core would have the models of all callers, and their tokens.
void ForbidCoreDumps() {
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
  prctl(PR_SET_DUMPABLE, 0);  // for systems whose cores go to a program, which ignores the limit
}

// The cause of a failed handshake, in plain words, from gRPC's message about it.
std::string HandshakeFault(std::string_view text) {
  const std::pair<const char*, const char*> faults[] = {
      {"peer did not return a certificate", "the client showed no certificate"},
      {"certificate verify failed",
       "the certificate of the client is of no authority of --ca, or has expired"},
      {"CERTIFICATE_VERIFY_FAILED",
       "the certificate of the client is of no authority of --ca, or has expired"},
      {"unknown ca", "the client does not trust the authority of this server's certificate"},
      {"bad certificate", "the client refused the certificate of this server"},
      {"certificate expired", "the client finds the certificate of this server expired"},
      {"wrong version number", "the client does not speak TLS"},
      {"http request", "the client does not speak TLS"},
      {"unsupported protocol", "the client speaks no TLS 1.2 or 1.3"}};
  for (const auto& [words, fault] : faults) {
    if (text.find(words) != text.npos) return fault;
  }
  return std::string(text);
}

// gRPC itself writes to the log when a handshake fails, and of faults of its own.
void LogOfGrpc(gpr_log_func_args* line) {
  if (line->severity != GPR_LOG_SEVERITY_ERROR) return;
  const std::string_view text = line->message;
  if (text.find("andshake failed") == text.npos) {
    Log(LogLevel::kWarning, fmt::format("grpc: {}", text));
    return;
  }
  Counts().failed_handshakes.fetch_add(1);
  Log(LogLevel::kWarning, "a handshake of TLS failed", {{"cause", HandshakeFault(text)}});
}

}  // namespace

absl::StatusOr<std::unique_ptr<RunningServer>> StartServer(const ServerOptions& options) {
  PM_ASSIGN_OR_RETURN(const std::vector<SocketAddress> addresses, ResolveListenAddress(options.listen));
  const bool certificates = !options.ca_file.empty();
  ServerParts parts;
  PM_ASSIGN_OR_RETURN(parts.tls, ReadTls(options));
  const std::shared_ptr<TlsState> tls = parts.tls;
  PM_RETURN_IF_ERROR(CheckEncrypted(options, addresses));
  if (!options.tokens_file.empty()) {
    PM_ASSIGN_OR_RETURN(parts.callers, ReadCallers(options.tokens_file, certificates));
  }
  PM_ASSIGN_OR_RETURN(parts.listener, Listener::Bind(addresses, options.listen, RaiseConnectionLimit()));
  PM_ASSIGN_OR_RETURN(parts.disk, OpenCache(options));
  auto server = std::make_unique<GrpcServer>(options, std::move(parts));
  if (!server->started()) return absl::InternalError("gRPC does not start");
  server->WatchFiles();
  if (options.log_requests) {
    Log(LogLevel::kInfo,
        fmt::format("patchmill {} listens on {}, port {}", ServerVersion(), options.listen, server->port()));
    if (tls) LogCertificate(tls->files());
  }
  if (!options.metrics_listen.empty()) {
    PM_ASSIGN_OR_RETURN(const int port, server->ServeMetrics());
    if (options.log_requests) Log(LogLevel::kInfo, fmt::format("metrics are at port {}", port));
  }
  return server;
}

std::unique_ptr<RunningServer> StartEmbeddedServer(ServerOptions options) {
  options.log_requests = false;
  auto server = std::make_unique<GrpcServer>(options, ServerParts());
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
  sigaddset(&signals, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::signal(SIGXFSZ, SIG_IGN);  // a file of the cache that grows beyond its limit is an error of write

  LowerPriorityOfWorkers();
  ForbidCoreDumps();
  SetLogFormat(options.log_format == "json" ? LogFormat::kJson : LogFormat::kText);
  gpr_set_log_function(&LogOfGrpc);
  ServerOptions served = options;
  served.lower_priority_of_jobs = true;
  absl::StatusOr<std::unique_ptr<RunningServer>> server = StartServer(served);
  if (!server.ok()) {
    fmt::print(stderr, "patchmill: {}\n", std::string(server.status().message()));
    return 2;
  }
  int signal = SIGHUP;
  while (signal == SIGHUP) {
    sigwait(&signals, &signal);
    if (signal == SIGHUP) (*server)->Reload();
  }
  Log(LogLevel::kInfo, fmt::format("signal {}: draining for at most {} s", signal, options.drain_seconds));
  (*server)->Drain(options.drain_seconds);
  Log(LogLevel::kInfo, "stopped");
  return 0;
}

}  // namespace patchmill
