// The lanes for processors with AVX2.
#include "cam/location/simd/lane_kernel.h"

#ifdef PATCHMILL_X86_VECTORS
// Shared headers are included before the instruction set is chosen, so that no copy of them is made for it.
#include <immintrin.h>

#include "core/math/bernstein.h"

#pragma GCC target("avx2")
#define PM_LANES lanes_avx2
#define PM_LANE_WIDTH 4
#include "cam/location/simd/lane_visit.h"

namespace patchmill::internal {

LaneKernel Avx2LaneKernel() {
  return {lanes_avx2::VisitLeafLanes, lanes_avx2::MeetsLanes, lanes_avx2::ApproachLanes};
}

}  // namespace patchmill::internal
#endif
