// Writes a picture with a palette as PNG (ISO/IEC 15948). The data are stored, not compressed.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace patchmill {

struct PalettePicture {
  int width = 0, height = 0;                         // px
  std::vector<std::array<std::uint8_t, 3>> palette;  // red, green, blue; 1 to 256 entries
  std::vector<std::uint8_t> pixels;                  // row by row from the top, indices into the palette
};

// The bytes of the file: a little more than width * height. `picture` must be consistent.
std::string WritePng(const PalettePicture& picture);

}  // namespace patchmill
