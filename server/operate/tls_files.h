// Certificates and keys of a server, checked before a client meets them.
#pragma once

#include <chrono>
#include <string>

#include <absl/status/statusor.h>

namespace patchmill {

struct TlsPaths {
  std::string cert, key;
  std::string ca;  // empty: clients need no certificate
};

struct TlsFiles {
  std::string cert, key, ca;                    // PEM
  std::chrono::system_clock::time_point until;  // the certificate of the server is good until then
};

// Reads the files. INVALID_ARGUMENT with option, file and what is wrong with it: it cannot be read, holds no
// certificate or no key, its key is encrypted or of another certificate, its certificate has expired or is
// not valid yet.
absl::StatusOr<TlsFiles> ReadTlsFiles(const TlsPaths& paths);

}  // namespace patchmill
