// The memory that a job will take, estimated before anything of it is computed.
#pragma once

#include <cstdint>

#include "cam/plan/job.h"
#include "core/network/patch_model.h"

namespace patchmill {

// Bytes for planning and judging a job. The patches with their trees are counted, and the points of passes
// over the whole area of the control nets at the step between passes on a plane. A job that needs more gets
// it while there is some. A stock counts with its patches and the squares on which it is known. Cost: one
// pass over the control points.
std::int64_t EstimateMemory(const PatchModel& model, const Job& job);

}  // namespace patchmill
