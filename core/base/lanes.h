// Lanes: arithmetic and comparisons lane by lane (GCC and Clang vectors, same bits as scalar code).
#pragma once

namespace patchmill {

using Float4 = float __attribute__((vector_size(16)));

inline Float4 Splat(float x) { return Float4{x, x, x, x}; }
inline Float4 Max(Float4 a, Float4 b) { return a > b ? a : b; }
inline Float4 Min(Float4 a, Float4 b) { return a < b ? a : b; }

}  // namespace patchmill
