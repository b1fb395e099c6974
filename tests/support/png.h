// Reads pictures back with a reader that is not ours.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace patchmill::testing {

struct DecodedPng {
  int width = 0, height = 0, channels = 0;          // 0 if the file cannot be read
  std::vector<std::array<std::uint8_t, 3>> pixels;  // row by row from the top

  int Count(const std::array<std::uint8_t, 3>& color) const;
};

DecodedPng DecodePng(const std::string& file);

}  // namespace patchmill::testing
