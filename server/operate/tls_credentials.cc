#include "server/operate/tls_credentials.h"

#include <utility>

#include <grpc/grpc.h>
#include <grpc/grpc_security.h>

namespace patchmill {

void TlsState::Set(TlsFiles files) {
  const std::lock_guard<std::mutex> lock(mutex_);
  files_ = std::move(files);
  taken_ = false;
}

TlsFiles TlsState::files() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return files_;
}

bool TlsState::wants_clients() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return !files_.ca.empty();
}

bool TlsState::TakeNew(TlsFiles* files) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (taken_) return false;
  taken_ = true;
  *files = files_;
  return true;
}

// gRPC's C++ classes read certificates once. Its core asks this function at every handshake.
class TlsCredentials final : public grpc::ServerCredentials {
 public:
  explicit TlsCredentials(std::shared_ptr<TlsState> state) : state_(std::move(state)) {
    const auto clients = state_->wants_clients() ? GRPC_SSL_REQUEST_AND_REQUIRE_CLIENT_CERTIFICATE_AND_VERIFY
                                                 : GRPC_SSL_DONT_REQUEST_CLIENT_CERTIFICATE;
    credentials_ = grpc_ssl_server_credentials_create_with_options(
        grpc_ssl_server_credentials_create_options_using_config_fetcher(clients, &Fetch, state_.get()));
  }
  ~TlsCredentials() override { grpc_server_credentials_release(credentials_); }

  void SetAuthMetadataProcessor(const std::shared_ptr<grpc::AuthMetadataProcessor>&) override {}

 private:
  static grpc_ssl_certificate_config_reload_status Fetch(void* state,
                                                         grpc_ssl_server_certificate_config** config) {
    TlsFiles files;
    if (!static_cast<TlsState*>(state)->TakeNew(&files)) return GRPC_SSL_CERTIFICATE_CONFIG_RELOAD_UNCHANGED;
    const grpc_ssl_pem_key_cert_pair pair{files.key.c_str(), files.cert.c_str()};
    // gRPC wants authorities also where it asks no client for a certificate, and does not use them then.
    const std::string& authorities = files.ca.empty() ? files.cert : files.ca;
    *config = grpc_ssl_server_certificate_config_create(authorities.c_str(), &pair, 1);
    return GRPC_SSL_CERTIFICATE_CONFIG_RELOAD_NEW;
  }

  int AddPortToServer(const std::string& address, grpc_server* server) override {
    return grpc_server_add_http2_port(server, address.c_str(), credentials_);
  }

  const std::shared_ptr<TlsState> state_;
  grpc_server_credentials* credentials_ = nullptr;
};

std::shared_ptr<grpc::ServerCredentials> MakeTlsCredentials(std::shared_ptr<TlsState> state) {
  return std::make_shared<TlsCredentials>(std::move(state));
}

}  // namespace patchmill
