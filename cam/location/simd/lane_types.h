// Vectors of doubles, with one ball per lane. Each translation unit includes this file once, after it has
// chosen the instruction set. It must set PM_LANES (the name of its namespace) and PM_LANE_WIDTH (2, 4 or 8).
#pragma once

#if defined(__x86_64__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

#include "cam/location/simd/lane_kernel.h"

#define PM_LANE_INLINE inline __attribute__((always_inline))

namespace patchmill::internal::PM_LANES {

constexpr int kWidth = PM_LANE_WIDTH;
using D = double __attribute__((vector_size(8 * PM_LANE_WIDTH)));
using M = long long __attribute__((vector_size(8 * PM_LANE_WIDTH)));  // -1 or 0 per lane

PM_LANE_INLINE D Splat(double x) { return D{} + x; }
PM_LANE_INLINE M SplatInt(long long x) { return M{} + x; }
PM_LANE_INLINE D Load(const double* p) { return *reinterpret_cast<const D*>(p); }
PM_LANE_INLINE M Load(const std::int64_t* p) { return *reinterpret_cast<const M*>(p); }
PM_LANE_INLINE void Store(double* p, D x) { *reinterpret_cast<D*>(p) = x; }
PM_LANE_INLINE void Store(std::int64_t* p, M x) { *reinterpret_cast<M*>(p) = x; }

PM_LANE_INLINE D Max(D a, D b) { return a > b ? a : b; }
PM_LANE_INLINE D Min(D a, D b) { return a < b ? a : b; }
PM_LANE_INLINE D Abs(D a) { return a < 0.0 ? -a : a; }
PM_LANE_INLINE D Clamp(D x, D lo, D hi) { return Min(Max(x, lo), hi); }

PM_LANE_INLINE D Sqrt(D x) {
#if defined(__x86_64__) && PM_LANE_WIDTH == 8
  return _mm512_maskz_sqrt_pd(static_cast<__mmask8>(-1), x);  // _mm512_sqrt_pd warns in GCC 12
#elif defined(__x86_64__) && PM_LANE_WIDTH == 4
  return _mm256_sqrt_pd(x);
#elif defined(__x86_64__)
  return _mm_sqrt_pd(x);
#elif defined(__aarch64__)
  return vsqrtq_f64(x);
#else
  D r;
  for (int k = 0; k < kWidth; ++k) r[k] = __builtin_sqrt(x[k]);
  return r;
#endif
}

PM_LANE_INLINE unsigned Bits(M m) {
#if defined(__x86_64__) && PM_LANE_WIDTH == 8
  return _mm512_movepi64_mask(reinterpret_cast<__m512i>(m));
#elif defined(__x86_64__) && PM_LANE_WIDTH == 4
  return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(m)));
#elif defined(__x86_64__)
  return static_cast<unsigned>(_mm_movemask_pd(reinterpret_cast<__m128d>(m)));
#else
  unsigned bits = 0;
  for (int k = 0; k < kWidth; ++k) bits |= (m[k] != 0 ? 1U : 0U) << k;
  return bits;
#endif
}
PM_LANE_INLINE bool Any(M m) { return Bits(m) != 0; }

struct V3 {
  D x, y, z;
};
PM_LANE_INLINE D Dot(const V3& a, const V3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
PM_LANE_INLINE D Dot(const V3& a, const double* b) { return a.x * b[0] + a.y * b[1] + a.z * b[2]; }
PM_LANE_INLINE D DotXy(const V3& a, const V3& b) { return a.x * b.x + a.y * b.y; }
PM_LANE_INLINE void AddTimes(V3& sum, D t, const V3& a) {
  sum.x += t * a.x;
  sum.y += t * a.y;
  sum.z += t * a.z;
}
PM_LANE_INLINE void AddTimes(V3& sum, D t, const double* a) {
  sum.x += t * a[0];
  sum.y += t * a[1];
  sum.z += t * a[2];
}
PM_LANE_INLINE V3 Zero3() { return {D{}, D{}, D{}}; }

}  // namespace patchmill::internal::PM_LANES
