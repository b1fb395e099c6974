#include "cam/path/contour_paths.h"

#include <utility>

#include <fmt/format.h>

#include "cam/path/certify_centers.h"
#include "cam/path/chord_thinning.h"
#include "cam/path/contour_levels.h"
#include "cam/path/contour_samples.h"
#include "cam/path/level_trace.h"
#include "cam/path/loop_clip.h"
#include "cam/path/spacing.h"
#include "core/base/parallel.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

constexpr std::size_t kMostLevels = 50000;

struct LevelPasses {
  std::vector<CutterPath> paths;
  double z = 0.0;
  int ambiguous = 0;
  Vec3 ambiguous_at = Vec3::Zero();
};

LevelPasses PassesAt(const LevelContext& context, const PlannedLevel& planned, double spacing,
                     const ContourParams& params, const RunContext& run) {
  const LevelContours level = TracePasses(context, planned.z, params, run);
  LevelPasses passes{{}, level.z, level.ambiguous_cells, level.ambiguous_at};
  ClipParams clip;
  clip.window = params.window;
  clip.roll = params.roll;
  clip.overlap = 0.5 * CenterStep(context.locator.radius(), params.scallop, 0.0);
  if (planned.partial) {
    clip.spots = planned.spots;
    clip.near = 1.5 * spacing + 2.0 * planned.gap;
  }
  for (const CutterPath& loop : level.loops) {
    if (run.Cancelled()) break;
    for (CutterPath& part : ClipLoop(context, loop, clip)) {
      CertifyCenters(context.locator, CertificateGap(params), part);
      passes.paths.push_back(std::move(part));
    }
  }
  return passes;
}

}  // namespace

LevelContours TraceLevel(const Locator& locator, double z, const ContourParams& params,
                         const RunContext& run) {
  return TraceLevel(LevelContext(locator, run), z, params, run);
}

absl::StatusOr<ContourResult> ContourPaths(const Locator& locator, const ContourParams& params,
                                           const RunContext& run) {
  const LevelContext context(locator, run);
  PM_RETURN_IF_ERROR(run.Check());
  PM_ASSIGN_OR_RETURN(const ContourGround ground, SampleGround(context, params, run));
  const std::vector<PlannedLevel> levels = PlanLevels(ground, params, locator.radius());
  if (levels.size() > kMostLevels) {
    return absl::ResourceExhaustedError(
        fmt::format("contours would need {} levels, more than {}: raise the scallop or the tool's radius",
                    levels.size(), kMostLevels));
  }
  std::vector<LevelPasses> passes(levels.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, "contours", levels.size(), [&](std::size_t i) {
    passes[i] = PassesAt(context, levels[i], ground.spacing, params, run);
  }));
  PM_RETURN_IF_ERROR(run.Check());
  ContourResult result;
  for (std::size_t i = 0; i < passes.size(); ++i) {
    for (CutterPath& path : passes[i].paths) {
      path.line = static_cast<int>(i);
      result.paths.push_back(std::move(path));
    }
    if (passes[i].ambiguous > 0) {
      Diagnostic finding;
      finding.code = "CONTOUR_AMBIGUOUS";
      finding.severity = Severity::kInfo;
      finding.message = fmt::format(
          "contour at centre height {:.4f} mm: {} cells of {:.4f} mm, the first here, could not be decided; "
          "they "
          "count as material",
          passes[i].z, passes[i].ambiguous, params.resolution / 8.0);
      finding.where.point = passes[i].ambiguous_at;
      result.findings.push_back(std::move(finding));
    }
  }
  return result;
}

}  // namespace patchmill
