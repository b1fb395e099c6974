#include "clients/cli/connection.h"

#include <chrono>
#include <string_view>

#include <fmt/format.h>
#include <grpcpp/channel.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/support/channel_arguments.h>

#include "clients/cli/input_file.h"
#include "clients/cli/option_names.h"

namespace patchmill::cli {
namespace {

constexpr std::size_t kMaxMessageBytes = kMaxFileBytes;  // of client and server

// The service knows a model by its field, the user by its file.
std::string InWords(const grpc::Status& status) {
  const std::string& message = status.error_message();
  for (const std::string_view field : {"model file: ", "job.source.file.content.", "source.file.content."}) {
    if (NameOfModel().empty() || message.compare(0, field.size(), field) != 0) continue;
    return fmt::format("{}: {}", NameOfModel(), message.substr(field.size()));
  }
  const char* option = OptionOf(message);
  return option != nullptr ? fmt::format("{}: {}", option, message) : message;
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

}  // namespace

absl::StatusOr<Connection> Connect(const CommonOptions& options) {
  Connection connection;
  if (options.server.empty()) {
    ServerOptions server;
    server.threads = options.threads;
    server.max_job_seconds = 7 * 86400.0;  // the machine is the user's own; --timeout decides
    server.max_in_flight_mib = 4096;
    connection.embedded = StartEmbeddedServer(server);
    connection.channel = connection.embedded->InProcessChannel();
    return connection;
  }
  const auto credentials = Credentials(options);
  if (!credentials.ok()) return credentials.status();
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(static_cast<int>(kMaxMessageBytes));
  arguments.SetMaxSendMessageSize(static_cast<int>(kMaxMessageBytes));
  connection.channel = grpc::CreateCustomChannel(options.server, *credentials, arguments);
  return connection;
}

CallScope::CallScope(const CommonOptions& options, InterruptWatch& watch) : watch_(watch) {
  if (options.timeout) {
    context_.set_deadline(std::chrono::system_clock::now() +
                          std::chrono::milliseconds(static_cast<std::int64_t>(1000.0 * *options.timeout)));
  }
  watch_.Attach(&context_);
}

absl::Status FromGrpc(const grpc::Status& status, const CommonOptions& options, const InterruptWatch& watch) {
  if (status.ok()) return absl::OkStatus();
  const auto code = static_cast<absl::StatusCode>(status.error_code());
  if (watch.interrupted()) return absl::CancelledError("interrupted");
  switch (status.error_code()) {
    case grpc::StatusCode::DEADLINE_EXCEEDED:
      return absl::DeadlineExceededError(
          options.timeout ? fmt::format("not done within --timeout {:g} s", *options.timeout)
                          : status.error_message());
    case grpc::StatusCode::UNAVAILABLE:
      return absl::UnavailableError(options.server.empty()
                                        ? status.error_message()
                                        : fmt::format("{}: {}", options.server, status.error_message()));
    case grpc::StatusCode::INTERNAL:
      return absl::InternalError("a bug of Patchmill: " + status.error_message());
    default:
      return {code, InWords(status)};
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

absl::Status CheckRequestSize(std::size_t bytes) {
  if (bytes <= kMaxMessageBytes) return absl::OkStatus();
  return absl::InvalidArgumentError(fmt::format("the request has {:.1f} MiB; the limit is {} MiB",
                                                static_cast<double>(bytes) / (1 << 20),
                                                kMaxMessageBytes >> 20));
}

}  // namespace patchmill::cli
