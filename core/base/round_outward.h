// Rounds doubles to floats that bound them.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

namespace patchmill {

// The value of std::nextafterf(x, HUGE_VALF), without a function call.
inline float NextUp(float x) {
  if (!(x < HUGE_VALF)) return x;
  const auto bits = std::bit_cast<std::int32_t>(x + 0.0F);  // -0 as 0
  return std::bit_cast<float>(bits >= 0 ? bits + 1 : bits - 1);
}
// The float is never below x (RoundUp), never above x (RoundDown).
inline float RoundUp(double x) { return NextUp(static_cast<float>(x)); }
inline float RoundDown(double x) { return -NextUp(-static_cast<float>(x)); }

}  // namespace patchmill
