// Files of the repository and of the optional shared data beside it. For test programs only:
// PATCHMILL_SOURCE_DIR is defined for them.
#pragma once

#include <fstream>
#include <iterator>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "core/io/model_text.h"

namespace patchmill::testing {

inline std::optional<std::string> ReadFile(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(in), {});
}
// The text of a file below the repository's root; a missing one fails the test with its name and reads as "".
inline std::string ReadRepositoryFile(const std::string& path) {
  const auto text = ReadFile(PATCHMILL_SOURCE_DIR "/" + path);
  EXPECT_TRUE(text.has_value()) << "no such file: " << path;
  return text.value_or("");
}
// The text of a file below ../shared, an extra that need not be there.
inline std::optional<std::string> ReadSharedFile(const std::string& path) {
  return ReadFile(PATCHMILL_SOURCE_DIR "/../shared/" + path);
}
// The model in "tests/models/teacup.bpt", by the file's ending. A fault fails the test.
inline PatchModel LoadModel(const std::string& path) {
  auto model = ReadModelText(path.substr(path.rfind('.') + 1), ReadRepositoryFile(path));
  EXPECT_TRUE(model.ok()) << path << ": " << model.status();
  return model.ok() ? *std::move(model) : PatchModel();
}

}  // namespace patchmill::testing
