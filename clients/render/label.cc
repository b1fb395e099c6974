#include "clients/render/label.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#define STB_TRUETYPE_IMPLEMENTATION
#define STBTT_STATIC
#include <stb/stb_truetype.h>

// The assembler reads the font file (clients/CMakeLists.txt).
asm(".section .rodata\n"
    "patchmill_font_begin:\n"
    ".incbin \"" PATCHMILL_FONT
    "\"\n"
    ".previous\n");
extern const unsigned char font_begin[] asm("patchmill_font_begin");

namespace patchmill::render {
namespace {

const stbtt_fontinfo& Font() {
  static const stbtt_fontinfo font = [] {
    stbtt_fontinfo info;
    stbtt_InitFont(&info, font_begin, 0);
    return info;
  }();
  return font;
}

// The code points of UTF-8.
std::vector<int> CodePoints(std::string_view text) {
  std::vector<int> points;
  for (std::size_t at = 0; at < text.size();) {
    const auto first = static_cast<unsigned char>(text[at]);
    std::size_t more = first < 0x80 ? 0 : first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : first >= 0xc0 ? 1 : 4;
    int point = more == 0 ? first : first & (0x3f >> more);
    bool good = more < 4 && first < 0xf8 && at + more < text.size();
    for (std::size_t k = 1; good && k <= more; ++k) {
      const auto next = static_cast<unsigned char>(text[at + k]);
      good = (next & 0xc0) == 0x80;
      point = (point << 6) | (next & 0x3f);
    }
    if (!good) more = 0;
    points.push_back(good && point >= 32 && point != 127 ? point : '?');
    at += more + 1;
  }
  return points;
}

// Calls `visit(glyph, x)` for each character; `x` is where it begins, px. Returns where the text ends.
template <class Visit>
double Layout(std::string_view text, double height, const Visit& visit) {
  const stbtt_fontinfo& font = Font();
  const double scale = stbtt_ScaleForPixelHeight(&font, static_cast<float>(height));
  double x = 0.0;
  int last = 0;
  for (const int point : CodePoints(text)) {
    const int glyph = stbtt_FindGlyphIndex(&font, point);
    if (last != 0) x += scale * stbtt_GetGlyphKernAdvance(&font, last, glyph);
    visit(glyph, x);
    int advance = 0, bearing = 0;
    stbtt_GetGlyphHMetrics(&font, glyph, &advance, &bearing);
    x += scale * advance;
    last = glyph;
  }
  return x;
}

}  // namespace

double TextWidth(std::string_view text, double height) {
  return Layout(text, height, [](int, double) {});
}

void DrawText(Image& image, double x, double y, std::string_view text, const TextStyle& style) {
  const stbtt_fontinfo& font = Font();
  const float scale = stbtt_ScaleForPixelHeight(&font, static_cast<float>(style.height));
  int ascent = 0, descent = 0, gap = 0;
  stbtt_GetFontVMetrics(&font, &ascent, &descent, &gap);
  const int base = static_cast<int>(std::lround(y + scale * static_cast<float>(ascent)));
  std::vector<unsigned char> cover;
  Layout(text, style.height, [&](int glyph, double begin) {
    const double at = x + begin;
    const int left = static_cast<int>(std::floor(at));
    const auto shift = static_cast<float>(at - left);
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    stbtt_GetGlyphBitmapBoxSubpixel(&font, glyph, scale, scale, shift, 0.0F, &x0, &y0, &x1, &y1);
    const int width = x1 - x0, height = y1 - y0;
    if (width <= 0 || height <= 0) return;
    cover.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
    stbtt_MakeGlyphBitmapSubpixel(&font, cover.data(), width, height, width, scale, scale, shift, 0.0F,
                                  glyph);
    for (int row = 0; row < height; ++row) {
      for (int column = 0; column < width; ++column) {
        const int px = left + x0 + column, py = base + y0 + row;
        if (px < 0 || py < 0 || px >= image.size.width || py >= image.size.height) continue;
        const double share = cover[static_cast<std::size_t>(row * width + column)] / 255.0;
        image.At(px, py) = Mixed(image.At(px, py), style.color, share);
      }
    }
  });
}

std::string Shortened(std::string_view text, double height, double most_width) {
  if (TextWidth(text, height) <= most_width) return std::string(text);
  std::string shorter(text);
  while (!shorter.empty()) {
    // A character of several bytes goes as a whole.
    while (!shorter.empty() && (static_cast<unsigned char>(shorter.back()) & 0xc0) == 0x80)
      shorter.pop_back();
    if (!shorter.empty()) shorter.pop_back();
    if (TextWidth(shorter + "...", height) <= most_width) break;
  }
  return shorter + "...";
}

}  // namespace patchmill::render
