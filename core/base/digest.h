// Digests of 32 bytes: SHA-256 from OpenSSL's libcrypto, which gRPC links anyway.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace patchmill {

std::string Sha256(std::string_view bytes);  // 32 bytes
std::string Hex(std::string_view bytes);     // lower case

// Appends values in one defined way, so that equal values give equal bytes on every machine. Numbers are
// little endian, strings carry their length, and -0 counts as 0.
class Canonical {
 public:
  Canonical& Add(double value);
  Canonical& Add(std::int64_t value);
  Canonical& Add(std::string_view value);
  std::string Digest() const { return Sha256(bytes_); }

 private:
  std::string bytes_;
};

}  // namespace patchmill
