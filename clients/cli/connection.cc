#include "clients/cli/connection.h"

#include <algorithm>
#include <chrono>
#include <string_view>

#include <absl/strings/ascii.h>
#include <absl/strings/match.h>
#include <absl/strings/numbers.h>
#include <fmt/format.h>
#include <grpcpp/channel.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/support/channel_arguments.h>

#include "clients/cli/input_file.h"
#include "clients/cli/option_names.h"
#include "patchmill/v1/status.pb.h"

namespace patchmill::cli {
namespace {

constexpr std::size_t kMaxMessageBytes = kMaxFileBytes;  // of client and server

// The service knows an input by its field, the user by its file or option.
std::string InWords(const std::string& message) {
  for (const auto& [field, path] : NamedInputs()) {
    if (absl::StartsWith(message, field + ": ")) return path + message.substr(field.size());
    if (absl::StartsWith(message, field + ".")) return path + ": " + message.substr(field.size() + 1);
    if (absl::StartsWith(message, field + " = ")) return path + ": " + message;
  }
  const char* option = OptionOf(message);
  return option != nullptr ? fmt::format("{}: {}", option, message) : message;
}

// What the contract says of an error; empty where gRPC itself gave the status.
v1::ErrorInfo InfoOf(const grpc::Status& status) {
  v1::Status details;
  v1::ErrorInfo info;
  if (!details.ParseFromString(status.error_details())) return info;
  for (const google::protobuf::Any& detail : details.details()) {
    if (detail.UnpackTo(&info)) return info;
  }
  return {};
}

// The message of the server for a user; of several wrong fields, a line each.
std::string Worded(const grpc::Status& status) {
  const v1::ErrorInfo info = InfoOf(status);
  if (info.reason() == "CURVE_UNREADABLE" && !NamedInputs().empty())
    return fmt::format("{}: {}", NamedInputs().front().path, status.error_message());
  const int count = info.field_violations_size();
  if (count < 2) return InWords(status.error_message());
  std::string lines;
  for (const v1::FieldViolation& wrong : info.field_violations())
    lines +=
        (lines.empty() ? "" : "\n  ") + InWords(fmt::format("{} {}", wrong.field(), wrong.description()));
  if (info.violation_count() > count) lines += fmt::format("\n  and {} more", info.violation_count() - count);
  return lines;
}

// Whether gRPC's message says that there never was a connection.
bool HasNoConnection(const std::string& message) {
  for (const char* begin :
       {"failed to connect", "DNS resolution failed", "Failed to pick", "connections to all"}) {
    if (absl::StartsWith(message, begin)) return true;
  }
  return false;
}

// Why a server did not do a call that is right: it cannot be reached, was lost, shuts down, has too much to
// do or is another server. Empty for any other reason.
std::string ServerTrouble(const grpc::Status& status, const std::string& server) {
  const std::string& message = status.error_message();
  const std::string reason = InfoOf(status).reason();
  if (reason == "DRAINING" || reason == "TOO_MANY_JOBS" || reason == "TOO_MANY_BYTES" ||
      reason == "TOO_MUCH_MEMORY" || reason == "QUOTA_EXCEEDED")
    return fmt::format("{}: {}", server, message);
  if (status.error_code() == grpc::StatusCode::UNAUTHENTICATED)
    return fmt::format("{} does not know the caller: {}", server, message);
  if (status.error_code() == grpc::StatusCode::CANCELLED)
    return fmt::format("{} ended the call: it shuts down, or the answer was read too slowly", server);
  if (!reason.empty()) return "";
  if (status.error_code() == grpc::StatusCode::UNIMPLEMENTED)
    return fmt::format("{} has no such call: it is no server of Patchmill, or one of another version",
                       server);
  const Loss loss = LossOf(status);
  if (loss == Loss::kNone) return "";
  if (loss == Loss::kUnreachable) return fmt::format("no server answers at {}: {}", server, message);
  if (message == "Cancelling all calls")  // gRPC's word for the end of the time to drain
    return fmt::format("{} shut down before the call was done", server);
  return fmt::format("the connection to {} broke while the call ran: {}", server, message);
}

// Whether this is an address of gRPC: HOST:PORT, or one with a scheme (unix:/run/patchmill).
bool IsAddress(const std::string& address) {
  for (const char* scheme : {"unix:", "unix-abstract:", "dns:", "ipv4:", "ipv6:"})
    if (absl::StartsWith(address, scheme)) return true;
  const std::size_t colon = address.rfind(':');
  int port = 0;
  return colon != address.npos && colon > 0 && absl::SimpleAtoi(address.substr(colon + 1), &port) &&
         port > 0 && port < 65536;
}

// Credentials for TLS if a file is given, else for plain connections.
absl::StatusOr<std::shared_ptr<grpc::ChannelCredentials>> Credentials(const CommonOptions& options) {
  if (options.ca_file.empty() && options.cert_file.empty() && options.key_file.empty()) {
    return grpc::InsecureChannelCredentials();
  }
  if (options.cert_file.empty() != options.key_file.empty()) {
    return absl::InvalidArgumentError("--cert and --key belong together");
  }
  grpc::SslCredentialsOptions ssl;
  const std::pair<const std::string&, std::string&> files[] = {{options.ca_file, ssl.pem_root_certs},
                                                               {options.cert_file, ssl.pem_cert_chain},
                                                               {options.key_file, ssl.pem_private_key}};
  for (const auto& [path, pem] : files) {
    if (path.empty()) continue;
    absl::StatusOr<std::string> text = ReadWholeFile(path);
    if (!text.ok()) return text.status();
    pem = *std::move(text);
  }
  return grpc::SslCredentials(ssl);
}

// Whether an address stays on this machine. A name that only begins like such an address does not.
bool IsLoopback(const std::string& address) {
  if (absl::StartsWith(address, "unix:") || absl::StartsWith(address, "unix-abstract:")) return true;
  const std::string host = address.substr(0, address.rfind(':'));
  const bool is_number = host.find_first_not_of("0123456789.") == host.npos;
  return (is_number && absl::StartsWith(host, "127.")) || host == "localhost" || host == "[::1]";
}

}  // namespace

absl::StatusOr<std::string> ReadTokenFile(const std::string& path) {
  absl::StatusOr<std::string> text = ReadWholeFile(path);
  if (!text.ok()) return text.status();
  std::string token(absl::StripAsciiWhitespace(text->substr(0, text->find('\n'))));
  const bool printable = std::all_of(token.begin(), token.end(), [](char c) { return c > ' ' && c <= '~'; });
  if (token.empty() || !printable) {
    return absl::InvalidArgumentError(fmt::format(
        "{}: the first line must be a token, of printable ASCII characters without spaces", path));
  }
  return token;
}

absl::StatusOr<Connection> Connect(const CommonOptions& options, KeepModels keep) {
  Connection connection;
  if (options.server.empty()) {
    ServerOptions server;
    server.threads = options.threads;
    server.max_job_seconds = 7 * 86400.0;  // the machine is the user's own; --timeout decides
    server.max_in_flight_mib = 4096;
    server.store_mib = keep == KeepModels::kYes ? 4096 : 0;  // the only client asks once
    connection.embedded = StartEmbeddedServer(server);
    connection.channel = connection.embedded->InProcessChannel();
    return connection;
  }
  if (!IsAddress(options.server)) {
    return absl::InvalidArgumentError(
        fmt::format("--server {}; must be HOST:PORT, for example cam.example:50051", options.server));
  }
  const bool encrypted = !options.ca_file.empty() || !options.cert_file.empty();
  if (!options.token.empty() && !encrypted && !IsLoopback(options.server)) {
    return absl::InvalidArgumentError(
        fmt::format("--token-file: the token would be sent to {} without TLS; set --ca", options.server));
  }
  const auto credentials = Credentials(options);
  if (!credentials.ok()) return credentials.status();
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(static_cast<int>(kMaxMessageBytes));
  arguments.SetMaxSendMessageSize(static_cast<int>(kMaxMessageBytes));
  // A call that is made again looks soon for a server that was gone.
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 200);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 2000);
  connection.channel = grpc::CreateCustomChannel(options.server, *credentials, arguments);
  return connection;
}

std::string ReasonOf(const grpc::Status& status) { return InfoOf(status).reason(); }

Loss LossOf(const grpc::Status& status) {
  const std::string reason = ReasonOf(status);
  if (reason == "DRAINING") return Loss::kDraining;
  if (!reason.empty()) return Loss::kNone;
  const std::string& message = status.error_message();
  if (status.error_code() == grpc::StatusCode::UNAVAILABLE)
    return HasNoConnection(message) ? Loss::kUnreachable : Loss::kBroken;
  // A proxy that has passed on a part of the answer has no other way to say that the rest will not come.
  const bool is_reset =
      status.error_code() == grpc::StatusCode::INTERNAL && absl::StrContains(message, "RST_STREAM");
  return is_reset ? Loss::kBroken : Loss::kNone;
}

CallScope::CallScope(const CommonOptions& options, InterruptWatch& watch) : watch_(watch) {
  if (options.timeout) {
    context_.set_deadline(std::chrono::system_clock::now() +
                          std::chrono::milliseconds(static_cast<std::int64_t>(1000.0 * *options.timeout)));
  }
  if (!options.token.empty()) context_.AddMetadata("authorization", "Bearer " + options.token);
  if (!options.request_id.empty()) context_.AddMetadata("x-request-id", options.request_id);
  watch_.Attach(&context_);
}

absl::Status FromGrpc(const grpc::Status& status, const CommonOptions& options, const InterruptWatch& watch) {
  if (status.ok()) return absl::OkStatus();
  const auto code = static_cast<absl::StatusCode>(status.error_code());
  if (watch.interrupted()) return absl::CancelledError("interrupted");
  const std::string trouble = options.server.empty() ? "" : ServerTrouble(status, options.server);
  if (!trouble.empty()) return {code, trouble};
  switch (status.error_code()) {
    case grpc::StatusCode::DEADLINE_EXCEEDED:
      return absl::DeadlineExceededError(
          options.timeout ? fmt::format("not done within --timeout {:g} s", *options.timeout)
                          : status.error_message());
    case grpc::StatusCode::INTERNAL:
      return absl::InternalError("a bug of Patchmill: " + status.error_message());
    default:
      return {code, Worded(status)};
  }
}

int ExitStatus(const absl::Status& status) {
  switch (status.code()) {
    case absl::StatusCode::kOk:
      return 0;
    case absl::StatusCode::kInvalidArgument:
    case absl::StatusCode::kUnimplemented:
    case absl::StatusCode::kNotFound:
      return 2;
    default:
      return 1;
  }
}

bool FitsMessage(std::size_t bytes) { return bytes <= kMaxMessageBytes; }

absl::Status CheckRequestSize(std::size_t bytes) {
  if (FitsMessage(bytes)) return absl::OkStatus();
  return absl::InvalidArgumentError(fmt::format("the request has {:.1f} MiB; the limit is {} MiB",
                                                static_cast<double>(bytes) / (1 << 20),
                                                kMaxMessageBytes >> 20));
}

}  // namespace patchmill::cli
