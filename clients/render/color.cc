#include "clients/render/color.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace patchmill::render {
namespace {

std::uint8_t Byte(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

int HexDigit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

}  // namespace

Rgb FromHex(std::string_view text) {
  if (text.size() != 7 || text.front() != '#') return {};
  std::uint8_t parts[3] = {};
  for (std::size_t k = 0; k < 3; ++k) {
    const int high = HexDigit(text[1 + 2 * k]), low = HexDigit(text[2 + 2 * k]);
    if (high < 0 || low < 0) return {};
    parts[k] = static_cast<std::uint8_t>(16 * high + low);
  }
  return {parts[0], parts[1], parts[2]};
}

Rgb Lit(Rgb color, double light) {
  return {Byte(color.red * light), Byte(color.green * light), Byte(color.blue * light)};
}

Rgb Mixed(Rgb from, Rgb to, double share) {
  const auto mixed = [share](std::uint8_t a, std::uint8_t b) { return Byte(a + share * (b - a)); };
  return {mixed(from.red, to.red), mixed(from.green, to.green), mixed(from.blue, to.blue)};
}

Rgb ColorAt(const ColorScale& scale, double value) {
  if (std::isnan(value)) return scale.unknown;
  if (value < scale.low) return scale.under;
  if (value > scale.high) return scale.over;
  const double at =
      (value - scale.low) / (scale.high - scale.low) * static_cast<double>(scale.stops.size() - 1);
  const auto k = std::min(static_cast<std::size_t>(at), scale.stops.size() - 2);
  return Mixed(scale.stops[k], scale.stops[k + 1], at - static_cast<double>(k));
}

}  // namespace patchmill::render
