#include "core/base/digest.h"

#include <bit>

#include <openssl/evp.h>

#include "core/base/status.h"

namespace patchmill {

std::string Sha256(std::string_view bytes) {
  std::string digest(32, '\0');
  unsigned int size = 0;
  PM_CHECK(EVP_Digest(bytes.data(), bytes.size(), reinterpret_cast<unsigned char*>(digest.data()), &size,
                      EVP_sha256(), nullptr) == 1);
  PM_CHECK(size == digest.size());
  return digest;
}

std::string Hex(std::string_view bytes) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  text.reserve(2 * bytes.size());
  for (const char c : bytes) {
    const auto b = static_cast<unsigned char>(c);
    text += kDigits[b >> 4];
    text += kDigits[b & 15];
  }
  return text;
}

Canonical& Canonical::Add(std::int64_t value) {
  const auto bits = static_cast<std::uint64_t>(value);
  for (int i = 0; i < 8; ++i) bytes_ += static_cast<char>((bits >> (8 * i)) & 0xff);
  return *this;
}

Canonical& Canonical::Add(double value) {
  return Add(std::bit_cast<std::int64_t>(value == 0.0 ? 0.0 : value));
}

Canonical& Canonical::Add(std::string_view value) {
  Add(static_cast<std::int64_t>(value.size()));
  bytes_ += value;
  return *this;
}

}  // namespace patchmill
