// TLS of a server whose certificates may change while it runs.
#pragma once

#include <memory>
#include <mutex>

#include <grpcpp/security/server_credentials.h>

#include "server/operate/tls_files.h"

namespace patchmill {

// The files that new connections use. Any thread may call it.
class TlsState {
 public:
  explicit TlsState(TlsFiles files) : files_(std::move(files)) {}
  // New connections use these. Open ones stay as they are. Whether clients need a certificate stays, too.
  void Set(TlsFiles files);
  TlsFiles files() const;
  bool wants_clients() const;

 private:
  friend class TlsCredentials;
  // The newest files, where they are not the last that were taken.
  bool TakeNew(TlsFiles* files);

  mutable std::mutex mutex_;
  TlsFiles files_;
  bool taken_ = false;
};

std::shared_ptr<grpc::ServerCredentials> MakeTlsCredentials(std::shared_ptr<TlsState> state);

}  // namespace patchmill
