// The lanes without any special instruction set: two doubles at a time, which SSE2 and NEON have.
#define PM_LANES lanes_plain
#define PM_LANE_WIDTH 2
#include "cam/location/simd/lane_visit.h"

namespace patchmill::internal {

LaneKernel PlainLaneKernel() {
  return {lanes_plain::VisitLeafLanes, lanes_plain::MeetsLanes, lanes_plain::ApproachLanes};
}

}  // namespace patchmill::internal
