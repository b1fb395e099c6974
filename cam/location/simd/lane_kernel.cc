#include "cam/location/simd/lane_kernel.h"

namespace patchmill::internal {

// No function of a kernel runs on a processor that cannot run it, not even the function that returns the
// kernel.
const LaneKernel& UsedLaneKernel() {
#ifdef PATCHMILL_X86_VECTORS
  const InstructionSet used = UsedInstructionSet();
  if (used == InstructionSet::kAvx512) {
    static const LaneKernel kernel = Avx512LaneKernel();
    return kernel;
  }
  if (used == InstructionSet::kAvx2) {
    static const LaneKernel kernel = Avx2LaneKernel();
    return kernel;
  }
#endif
  static const LaneKernel plain = PlainLaneKernel();
  return plain;
}

}  // namespace patchmill::internal
