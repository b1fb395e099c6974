// Colours of pictures, and scales that turn a value into one.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace patchmill::render {

struct Rgb {
  std::uint8_t red = 0, green = 0, blue = 0;
  friend bool operator==(const Rgb&, const Rgb&) = default;
};

// "#d7191c" of style sheets. Black if `text` is no such colour.
Rgb FromHex(std::string_view text);

// Each part of the colour times `light`, at most 255.
Rgb Lit(Rgb color, double light);

// `share` of `to`, the rest of `from`; `share` in [0, 1].
Rgb Mixed(Rgb from, Rgb to, double share);

struct ColorScale {
  double low = 0.0, high = 1.0;  // low < high
  std::vector<Rgb> stops;        // at equal distances from low to high; at least two
  Rgb under, over;               // of values below low and above high
  Rgb unknown;                   // of NaN
};

Rgb ColorAt(const ColorScale& scale, double value);

}  // namespace patchmill::render
