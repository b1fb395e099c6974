#include "cam/path/contour/contour_findings.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "cam/path/zlevel/level_trace.h"

namespace patchmill {

void ContourFindings::Take(const LevelContours& level) {
  if (kCellsPerResolution * level.cell > resolution_ * (1.0 + 1e-9)) Take(level, &coarse_);
  if (level.ambiguous_cells > 0) {
    Take(level, &ambiguous_);
    undecided_ += level.ambiguous_cells;
  }
}

void ContourFindings::Take(const LevelContours& level, Levels* of) {
  of->lowest = of->count == 0 ? level.z : std::min(of->lowest, level.z);
  of->highest = of->count == 0 ? level.z : std::max(of->highest, level.z);
  ++of->count;
  if (level.cell <= of->cell) return;
  of->cell = level.cell;
  of->where = level.ambiguous_cells > 0 ? std::optional<Vec3>(level.ambiguous_at) : std::nullopt;
}

Diagnostics ContourFindings::Findings() const {
  Diagnostics findings;
  const auto tell = [&](const char* code, Severity severity, const Levels& levels, const std::string& what) {
    if (levels.count == 0) return;
    const std::string at = levels.count == 1
                               ? fmt::format("contour at centre height {:.4f} mm", levels.highest)
                               : fmt::format("{} contours at centre heights from {:.4f} to {:.4f} mm",
                                             levels.count, levels.lowest, levels.highest);
    findings.push_back(
        MakeDiagnostic(severity, code, fmt::format("{}: {}", at, what), {.point = levels.where}));
  };
  tell("CONTOUR_COARSE", Severity::kWarning, coarse_,
       fmt::format("a resolution of {:.4g} mm takes too many cells, {:.4g} mm is held: loops and holes below "
                   "that may be missing, and count as material",
                   resolution_, kCellsPerResolution * coarse_.cell));
  tell("CONTOUR_AMBIGUOUS", Severity::kInfo, ambiguous_,
       fmt::format(
           "{} cells of up to {:.4f} mm, one of them here, could not be decided; they count as material",
           undecided_, ambiguous_.cell));
  return findings;
}

}  // namespace patchmill
