// The whole chain as one function: read this first.
#pragma once

#include <absl/status/statusor.h>

#include "cam/plan/job.h"
#include "cam/plan/region_choices.h"
#include "cam/plan/resolve.h"
#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

// Places the model (moved in: no copy is made) and joins it; the second builds the surface too, which keeps
// it. INVALID_ARGUMENT for a model that cannot be used.
absl::StatusOr<PatchNetwork> BuildPlacedNetwork(PatchModel model, const Setup& setup, const RunContext& run);
absl::StatusOr<Surface> BuildPlacedSurface(PatchModel model, const Setup& setup, const RunContext& run);

// Model findings of CheckModel: network, curvature against the tool, size warnings. A concave radius counts
// as below the ball's when it is smaller by more than `reach_tolerance`, mm (ReachTolerance).
struct ModelCheck {
  Diagnostics findings;
  Box3 box;                               // placed
  double min_concave_radius = kInfinity;  // mm, upward side
};
// WALL_WITHOUT_SIDE for each wall that may be milled on both sides (Surface::two_sided_walls). CheckModel has
// them, too.
Diagnostics WallsWithoutSide(const Surface& surface);

absl::StatusOr<ModelCheck> CheckModel(const Surface& surface, const std::optional<Tool>& tool,
                                      double reach_tolerance, const RunContext& run);

// Checks ranges of the job itself; INVALID_ARGUMENT with field path, value and constraint.
absl::Status ValidateJob(const Job& job);

// The regions of a job and how each is cut. Errors as ValidateJob, ChooseRegions.
absl::StatusOr<ChosenRegions> PlanRegions(const Surface& surface, const Job& job, const RunContext& run);

// The parts by which a program of this job is verified (MakeVerifyParams); none without region overrides.
// Errors as ChooseRegions.
absl::StatusOr<std::vector<PlanPart>> VerifiedParts(const Surface& surface, const Job& job,
                                                    const Resolved& resolved, const RunContext& run);

// surface -> regions -> passes -> links -> program text -> verification. No program unless verified.
absl::StatusOr<JobResult> RunJob(const Surface& surface, const Job& job, const RunContext& run);
// Plans a job that is resolved already: `resolved` is the result of Resolve(surface, job).
absl::StatusOr<JobResult> RunJob(const Surface& surface, const Job& job, const Resolved& resolved,
                                 const RunContext& run);

// The most moves that the text of such a motion is read as, its arcs as chords.
std::size_t MostMovesOf(const LinkResult& motion);

// Verification of any program text against the surface.
absl::StatusOr<VerifyReport> VerifyProgramText(const Surface& surface, const Tool& tool,
                                               std::string_view text, const VerifyParams& params,
                                               const RunContext& run);

}  // namespace patchmill
