// Which passes a job needs: the strategies put together and checked for coverage.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/plan/job_context.h"
#include "cam/plan/region_choices.h"
#include "cam/region/map/region_map.h"
#include "cam/toolpath/cutter_path.h"

namespace patchmill {

struct PlannedPasses {
  std::vector<CutterPath> paths;
  Diagnostics findings;
};

PassParams MakePassParams(const Job& job, const Resolved& resolved);

// The choices of all regions and the parts of the surface that they make.
struct JobParts {
  std::vector<RegionChoice> choices;        // by id
  std::vector<PlanPart> parts;              // PartsOf
  const OperationLimits* limits = nullptr;  // null: all is selected and allowed, and there is one part
};
JobParts PartsOfJob(const JobContext& context, const RegionMap& map, std::vector<RegionChoice> choices);

// All passes, stage by stage: part by part contours over the steep area and zig-zag lines over the gentle
// one, or one of them over all when it is forced; then passes along the borders that lines run along
// (Operation.border_passes); then pencil and rest passes wherever more than the part's scallop would stay;
// then redundant passes are removed and every pass gets the region that most of it lies in. Errors:
// RESOURCE_EXHAUSTED (PathLimits), CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<PlannedPasses> PlanPasses(const JobContext& context, const Locator& locator,
                                         const RegionMap& regions, const JobParts& job);

}  // namespace patchmill
