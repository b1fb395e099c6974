#include "tests/support/png.h"

#include <algorithm>
#include <cstring>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#include <stb/stb_image.h>

namespace patchmill::testing {

int DecodedPng::Count(const std::array<std::uint8_t, 3>& color) const {
  return static_cast<int>(std::count(pixels.begin(), pixels.end(), color));
}

DecodedPng DecodePng(const std::string& file) {
  DecodedPng png;
  unsigned char* const read =
      stbi_load_from_memory(reinterpret_cast<const unsigned char*>(file.data()),
                            static_cast<int>(file.size()), &png.width, &png.height, &png.channels, 3);
  if (read == nullptr) return {};
  png.pixels.resize(static_cast<std::size_t>(png.width) * static_cast<std::size_t>(png.height));
  std::memcpy(png.pixels.data(), read, 3 * png.pixels.size());
  stbi_image_free(read);
  return png;
}

}  // namespace patchmill::testing
