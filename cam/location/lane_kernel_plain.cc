// The lanes without any special instruction set: two doubles at a time, which SSE2 and NEON have.
#define PM_LANES lanes_plain
#define PM_LANE_WIDTH 2
#include "cam/location/lane_visit.h"

namespace patchmill::internal {

LaneKernel PlainLaneKernel() {
  return {"plain", lanes_plain::VisitLeafLanes, lanes_plain::MeetsLanes, lanes_plain::ApproachLanes};
}

namespace {

LaneKernels Detect() {
  LaneKernels found;
  const auto add = [&](const LaneKernel& kernel) { found.kernel[found.count++] = kernel; };
#ifdef PATCHMILL_X86_LANES
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")) add(Avx512LaneKernel());
  if (__builtin_cpu_supports("avx2")) add(Avx2LaneKernel());
#endif
  add(PlainLaneKernel());
  return found;
}

}  // namespace

const LaneKernels& AvailableLaneKernels() {
  static const LaneKernels kernels = Detect();
  return kernels;
}

}  // namespace patchmill::internal
