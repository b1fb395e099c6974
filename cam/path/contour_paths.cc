#include "cam/path/contour_paths.h"

#include <string>
#include <utility>

#include <fmt/format.h>

#include "cam/path/certify_centers.h"
#include "cam/path/chord_thinning.h"
#include "cam/path/contour_levels.h"
#include "cam/path/contour_samples.h"
#include "cam/path/level_heights.h"
#include "cam/path/level_trace.h"
#include "cam/path/loop_clip.h"
#include "cam/path/spacing.h"
#include "core/base/parallel.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

struct LevelPasses {
  std::vector<CutterPath> paths;
  Diagnostics findings;
};

Diagnostics FindingsOf(const LevelContours& level, const ContourParams& params) {
  Diagnostics findings;
  const auto add = [&](const char* code, Severity severity, std::string message) {
    Diagnostic& finding = findings.emplace_back();
    finding.code = code;
    finding.severity = severity;
    finding.message = fmt::format("contour at centre height {:.4f} mm: {}", level.z, message);
    if (level.ambiguous_cells > 0) finding.where.point = level.ambiguous_at;
  };
  const double held = kCellsPerResolution * level.cell;
  if (held > params.resolution * (1.0 + 1e-9)) {
    add("CONTOUR_COARSE", Severity::kWarning,
        fmt::format(
            "a resolution of {:.4g} mm takes too many cells, {:.4g} mm is held: loops and holes below "
            "that may be missing, and count as material",
            params.resolution, held));
  }
  if (level.ambiguous_cells > 0) {
    add("CONTOUR_AMBIGUOUS", Severity::kInfo,
        fmt::format("{} cells of {:.4f} mm, the first here, could not be decided; they count as material",
                    level.ambiguous_cells, level.cell));
  }
  return findings;
}

LevelPasses PassesAt(const LevelContext& context, const PlannedLevel& planned, double spacing,
                     const ContourParams& params, const RunContext& run) {
  const LevelContours level = TracePasses(context, planned.z, params, run);
  LevelPasses passes{{}, FindingsOf(level, params)};
  ClipParams clip;
  clip.window = params.window;
  clip.roll = params.roll;
  clip.overlap = 0.5 * CenterStep(context.locator.radius(), params.scallop, 0.0);
  if (planned.partial) {
    clip.spots = planned.spots;
    clip.near = ReachOfSpot(spacing, planned.gap);
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
  PM_ASSIGN_OR_RETURN(const std::vector<PlannedLevel> levels,
                      PlanLevels(ground, params, locator.radius(), run));
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
    for (Diagnostic& finding : passes[i].findings) result.findings.push_back(std::move(finding));
  }
  return result;
}

}  // namespace patchmill
