// Text in pictures, in DejaVu Sans.
#pragma once

#include <string>
#include <string_view>

#include "clients/render/image.h"

namespace patchmill::render {

struct TextStyle {
  double height = 15.0;  // px, from the lowest to the highest stroke of the font
  Rgb color;
};

// Width of a line of UTF-8, px. A byte that is no UTF-8, and a control character, counts as '?'.
double TextWidth(std::string_view text, double height);

// Draws one line of UTF-8. `x` is its left end and `y` its upper end, px. What lies beyond the image is
// left out.
void DrawText(Image& image, double x, double y, std::string_view text, const TextStyle& style);

// The text, or as much of its beginning as fits with "..." behind it.
std::string Shortened(std::string_view text, double height, double most_width);

}  // namespace patchmill::render
