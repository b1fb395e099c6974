#include <chrono>

#include <fmt/format.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>

#include "core/base/status.h"
#include "server/server.h"
#include "server/tls_files.h"

namespace patchmill {

namespace {

absl::StatusOr<std::shared_ptr<grpc::ChannelCredentials>> Credentials(const ServerOptions& options) {
  if (options.ca_file.empty() && options.cert_file.empty()) return grpc::InsecureChannelCredentials();
  grpc::SslCredentialsOptions ssl;
  // Without a named authority the health check trusts the server's own certificate.
  PM_ASSIGN_OR_RETURN(ssl.pem_root_certs,
                      ReadPemFile(options.ca_file.empty() ? options.cert_file : options.ca_file));
  if (!options.cert_file.empty() && !options.key_file.empty()) {
    PM_ASSIGN_OR_RETURN(ssl.pem_cert_chain, ReadPemFile(options.cert_file));
    PM_ASSIGN_OR_RETURN(ssl.pem_private_key, ReadPemFile(options.key_file));
  }
  return grpc::SslCredentials(ssl);
}

}  // namespace

int CheckHealth(const std::string& target_and_service, const ServerOptions& options) {
  // "HOST:PORT", or "HOST:PORT/liveness". A path of a Unix socket has slashes of its own.
  const std::size_t slash =
      target_and_service.starts_with("unix:") ? std::string::npos : target_and_service.find('/');
  const std::string target = target_and_service.substr(0, slash);
  const std::string service = slash == std::string::npos ? "" : target_and_service.substr(slash + 1);
  if (service.size() > 100) {
    fmt::print(stderr, "patchmill: --check-health {}; the name of the service is too long\n",
               target_and_service);
    return 1;
  }
  const auto credentials = Credentials(options);
  if (!credentials.ok()) {
    fmt::print(stderr, "patchmill: {}\n", std::string(credentials.status().message()));
    return 1;
  }
  // grpc.health.v1 is not packaged as a library. The request for the whole server is an empty message. A
  // server that serves answers with field 1 = 1.
  constexpr char kServing[] = {0x08, 0x01};
  grpc::TemplatedGenericStub<grpc::ByteBuffer, grpc::ByteBuffer> stub(
      grpc::CreateChannel(target, *credentials));
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(3));
  std::string bytes_of_request;  // field 1 is the name
  if (!service.empty()) bytes_of_request = std::string("\x0A") + static_cast<char>(service.size()) + service;
  grpc::Slice asked(bytes_of_request);
  const grpc::ByteBuffer request(&asked, 1);
  grpc::CompletionQueue queue;
  auto reader = stub.PrepareUnaryCall(&context, "/grpc.health.v1.Health/Check", request, &queue);
  reader->StartCall();
  grpc::ByteBuffer response;
  grpc::Status status;
  reader->Finish(&response, &status, nullptr);
  void* tag = nullptr;
  bool ok = false;
  queue.Next(&tag, &ok);
  std::string bytes;
  std::vector<grpc::Slice> slices;
  if (status.ok() && response.Dump(&slices).ok()) {
    for (const grpc::Slice& slice : slices)
      bytes.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
  }
  if (bytes == std::string_view(kServing, sizeof kServing)) return 0;
  fmt::print(stderr, "patchmill: {} is not serving{}{}\n", target, status.ok() ? "" : ": ",
             status.error_message());
  return 1;
}

}  // namespace patchmill
