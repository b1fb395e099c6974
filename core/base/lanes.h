// Four numbers at once: arithmetic and comparisons lane by lane (GCC and Clang vectors, same bits as scalar
// code).
#pragma once

#include <cstddef>
#include <cstring>
#include <vector>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace patchmill {

using Float4 = float __attribute__((vector_size(16)));
using Int4 = int __attribute__((vector_size(16)));

// The four numbers from[at] to from[at + 3].
inline Float4 Load(const std::vector<float>& from, std::size_t at) {
  Float4 lanes;
  std::memcpy(&lanes, &from[at], sizeof lanes);
  return lanes;
}
inline Float4 Splat(float x) { return Float4{x, x, x, x}; }
inline Float4 Max(Float4 a, Float4 b) { return a > b ? a : b; }
inline Float4 Min(Float4 a, Float4 b) { return a < b ? a : b; }

// Bit k is set where a < b in lane k.
inline unsigned BelowBits(Float4 a, Float4 b) {
#if defined(__SSE__)
  return static_cast<unsigned>(_mm_movemask_ps(_mm_cmplt_ps(a, b)));
#else
  unsigned bits = 0;
  for (int k = 0; k < 4; ++k) bits |= (a[k] < b[k] ? 1U : 0U) << k;
  return bits;
#endif
}

}  // namespace patchmill
