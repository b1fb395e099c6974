#include "core/patch/bicubic_sums.h"

#include <cstring>

#include "core/base/instruction_set.h"

namespace patchmill::internal {
namespace {

using Two = double __attribute__((vector_size(16)));
using Four = double __attribute__((vector_size(32)));

// Handles as many of the four numbers at a time as a register holds. The sums of all four, held in pairs,
// would not stay in registers.
template <class Numbers, bool kSeconds>
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
        if constexpr (kSeconds) rvv += bv.dd[j] * q;
      }
      p += bu.f[i] * r;
      du += bu.d[i] * r;
      dv += bu.f[i] * rv;
      if constexpr (kSeconds) {
        duu += bu.dd[i] * r;
        duv += bu.d[i] * rv;
        dvv += bu.f[i] * rvv;
      }
    }
    const Numbers sums[] = {p, du, dv, duu, duv, dvv};
    for (int k = 0; k < (kSeconds ? 6 : 3); ++k) std::memcpy(out + 4 * k + at, &sums[k], sizeof p);
  }
}

#ifdef PATCHMILL_X86_VECTORS
template <bool kSeconds>
__attribute__((target("avx2"))) void SumWithAvx2(const double* points, const BasisJet& bu, const BasisJet& bv,
                                                 double* out) {
  Sum<Four, kSeconds>(points, bu, bv, out);
}
#endif

template <bool kSeconds>
void SumOnUsedSet(const double* points, const BasisJet& bu, const BasisJet& bv, double* out) {
#ifdef PATCHMILL_X86_VECTORS
  if (UsedInstructionSet() != InstructionSet::kPlain) return SumWithAvx2<kSeconds>(points, bu, bv, out);
#endif
  Sum<Two, kSeconds>(points, bu, bv, out);
}

}  // namespace

void SumBicubic(const double* points, const BasisJet& bu, const BasisJet& bv, double* out) {
  SumOnUsedSet<true>(points, bu, bv, out);
}

void SumBicubicSlopes(const double* points, const BasisJet& bu, const BasisJet& bv, double* out) {
  SumOnUsedSet<false>(points, bu, bv, out);
}

}  // namespace patchmill::internal
