// Pictures of pixels, and the file that holds one.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "clients/render/color.h"

namespace patchmill::render {

struct PixelSize {
  int width = 0, height = 0;  // px
};

struct Image {
  PixelSize size;
  std::vector<Rgb> pixels;  // row by row from the top

  Rgb& At(int x, int y) { return pixels[Index(x, y)]; }
  Rgb At(int x, int y) const { return pixels[Index(x, y)]; }

 private:
  std::size_t Index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x);
  }
};

Image MakeImage(PixelSize size, Rgb background);

// Paints the pixels of a rectangle that lie in the image. `x` and `y` are its upper left corner.
void FillRectangle(Image& image, int x, int y, PixelSize size, Rgb color);

// The image as PNG (ISO/IEC 15948), 8 bits a colour. The bytes depend on the pixels alone.
std::string WritePng(const Image& image);

}  // namespace patchmill::render
