// The lanes for processors with AVX512.
#include "cam/location/simd/lane_kernel.h"

#ifdef PATCHMILL_X86_VECTORS
// Shared headers are included before the instruction set is chosen, so that no copy of them is made for it.
#include <immintrin.h>

#include "core/math/bernstein.h"

#pragma GCC target("avx512f,avx512dq")
#define PM_LANES lanes_avx512
#define PM_LANE_WIDTH 8
#include "cam/location/simd/lane_visit.h"

namespace patchmill::internal {

LaneKernel Avx512LaneKernel() {
  return {lanes_avx512::VisitLeafLanes, lanes_avx512::MeetsLanes, lanes_avx512::ApproachLanes};
}

}  // namespace patchmill::internal
#endif
