// Doubles as floats that bound them.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace patchmill {

// std::nextafterf(x, HUGE_VALF), which is a call.
inline float NextUp(float x) {
  if (!(x < HUGE_VALF)) return x;
  const auto bits = std::bit_cast<std::int32_t>(x + 0.0F);  // -0 as 0
  return std::bit_cast<float>(bits >= 0 ? bits + 1 : bits - 1);
}
// To floats without falling below, resp. rising above.
inline float RoundUp(double x) { return NextUp(static_cast<float>(x)); }
inline float RoundDown(double x) { return -NextUp(-static_cast<float>(x)); }

}  // namespace patchmill
