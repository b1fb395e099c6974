#include "core/patch/bicubic_sums.h"

#include <cstring>

#include "core/base/instruction_set.h"

namespace patchmill::internal {
namespace {

using Two = double __attribute__((vector_size(16)));
using Four = double __attribute__((vector_size(32)));

// As many of the four numbers at once as registers hold: sums of all four in pairs would not stay in them.
template <class Numbers>
inline __attribute__((always_inline)) void Sum(const double* points, const BasisJet& bu, const BasisJet& bv,
                                               double* out) {
  constexpr int kWidth = sizeof(Numbers) / sizeof(double);
  for (int at = 0; at < 4; at += kWidth) {
    Numbers p{}, du{}, dv{}, duu{}, duv{}, dvv{};
    for (int i = 0; i < 4; ++i) {
      Numbers r{}, rv{}, rvv{};
      for (int j = 0; j < 4; ++j) {
        Numbers q;
        std::memcpy(&q, points + 16 * i + 4 * j + at, sizeof q);
        r += bv.f[j] * q;
        rv += bv.d[j] * q;
        rvv += bv.dd[j] * q;
      }
      p += bu.f[i] * r;
      du += bu.d[i] * r;
      duu += bu.dd[i] * r;
      dv += bu.f[i] * rv;
      duv += bu.d[i] * rv;
      dvv += bu.f[i] * rvv;
    }
    const Numbers sums[] = {p, du, dv, duu, duv, dvv};
    for (int k = 0; k < 6; ++k) std::memcpy(out + 4 * k + at, &sums[k], sizeof p);
  }
}

template <class Numbers>
inline __attribute__((always_inline)) void SumSlopes(const double* points, const BasisJet& bu,
                                                     const BasisJet& bv, double* out) {
  constexpr int kWidth = sizeof(Numbers) / sizeof(double);
  for (int at = 0; at < 4; at += kWidth) {
    Numbers p{}, du{}, dv{};
    for (int i = 0; i < 4; ++i) {
      Numbers r{}, rv{};
      for (int j = 0; j < 4; ++j) {
        Numbers q;
        std::memcpy(&q, points + 16 * i + 4 * j + at, sizeof q);
        r += bv.f[j] * q;
        rv += bv.d[j] * q;
      }
      p += bu.f[i] * r;
      du += bu.d[i] * r;
      dv += bu.f[i] * rv;
    }
    const Numbers sums[] = {p, du, dv};
    for (int k = 0; k < 3; ++k) std::memcpy(out + 4 * k + at, &sums[k], sizeof p);
  }
}

#ifdef PATCHMILL_X86_VECTORS
__attribute__((target("avx2"))) void SumWithAvx2(const double* points, const BasisJet& bu, const BasisJet& bv,
                                                 double* out) {
  Sum<Four>(points, bu, bv, out);
}
__attribute__((target("avx2"))) void SumSlopesWithAvx2(const double* points, const BasisJet& bu,
                                                       const BasisJet& bv, double* out) {
  SumSlopes<Four>(points, bu, bv, out);
}
#endif

}  // namespace

void SumBicubic(const double* points, const BasisJet& bu, const BasisJet& bv, double* out) {
#ifdef PATCHMILL_X86_VECTORS
  if (UsedInstructionSet() != InstructionSet::kPlain) return SumWithAvx2(points, bu, bv, out);
#endif
  Sum<Two>(points, bu, bv, out);
}

void SumBicubicSlopes(const double* points, const BasisJet& bu, const BasisJet& bv, double* out) {
#ifdef PATCHMILL_X86_VECTORS
  if (UsedInstructionSet() != InstructionSet::kPlain) return SumSlopesWithAvx2(points, bu, bv, out);
#endif
  SumSlopes<Two>(points, bu, bv, out);
}

}  // namespace patchmill::internal
