// Which passes a job needs: the strategies put together and checked for coverage.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/location/limits/operation_limits.h"
#include "cam/plan/region_choices.h"
#include "cam/plan/resolve.h"
#include "cam/region/map/region_map.h"
#include "cam/toolpath/cutter_path.h"

namespace patchmill {

struct PlannedPasses {
  std::vector<CutterPath> paths;
  Diagnostics findings;
};

PassParams MakePassParams(const Job& job, const Resolved& resolved);

// `parts`: of the regions and their `choices` (PartsOf). `operation_limits`: what is wanted and allowed;
// null: all of
// it, and there is one part. Part by part contours over the steep ground, zig-zag lines over the gentle one
// (or one of them over all, when forced), then passes along borders that lines run along
// (Operation.border_passes), then crease and rest passes wherever more than the part's scallop would stay;
// each labelled with the region most of it lies in.
absl::StatusOr<PlannedPasses> PlanPasses(const Locator& locator, const RegionMap& regions,
                                         const std::vector<RegionChoice>& choices,
                                         const std::vector<PlanPart>& parts, const Job& job,
                                         const Resolved& resolved, const OperationLimits* operation_limits,
                                         const RunContext& run);

}  // namespace patchmill
