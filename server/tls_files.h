// Reads the small files of certificates and keys.
#pragma once

#include <fstream>
#include <sstream>
#include <string>

#include <absl/status/statusor.h>

namespace patchmill {

inline absl::StatusOr<std::string> ReadPemFile(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf())) return absl::InvalidArgumentError("cannot read " + path);
  return text.str();
}

}  // namespace patchmill
