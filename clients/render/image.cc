#include "clients/render/image.h"

#include <algorithm>
#include <cstddef>

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

namespace patchmill::render {

static_assert(sizeof(Rgb) == 3, "the rows of an image are the bytes that the encoder reads");

Image MakeImage(PixelSize size, Rgb background) {
  return {size, std::vector<Rgb>(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height),
                                 background)};
}

void FillRectangle(Image& image, int x, int y, PixelSize size, Rgb color) {
  const int right = std::min(image.size.width, x + size.width);
  const int bottom = std::min(image.size.height, y + size.height);
  for (int row = std::max(0, y); row < bottom; ++row)
    for (int column = std::max(0, x); column < right; ++column) image.At(column, row) = color;
}

std::string WritePng(const Image& image) {
  std::string file;
  const auto append = [](void* to, void* bytes, int size) {
    static_cast<std::string*>(to)->append(static_cast<const char*>(bytes), static_cast<std::size_t>(size));
  };
  stbi_write_png_to_func(append, &file, image.size.width, image.size.height, 3, image.pixels.data(),
                         3 * image.size.width);
  return file;
}

}  // namespace patchmill::render
