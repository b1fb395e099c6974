#include "cam/plan/region_steps.h"

#include <algorithm>
#include <cmath>

#include "cam/path/across_feed.h"
#include "cam/path/spacing.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/diffgeo/forms.h"

namespace patchmill {
namespace {

constexpr double kMostPoints = 200'000;

struct Range {
  double min = kInfinity, max = 0.0;
  void Add(double x) {
    min = std::min(min, x);
    max = std::max(max, x);
  }
  void Add(const Range& other) {
    min = std::min(min, other.min);
    max = std::max(max, other.max);
  }
};

bool ByContours(const RegionChoice& choice, const Region& region) {
  return choice.strategy == Strategy::kContour ||
         (choice.strategy == Strategy::kAuto && region.slope == SlopeClass::kSteep);
}

std::vector<Range> PieceSteps(const Piece& piece, const std::vector<int>& labels, int cells, int stride,
                              const RegionMap& map, const std::vector<RegionChoice>& choices, double radius) {
  std::vector<Range> steps(map.regions.size());
  for (int i = stride / 2; i < cells; i += stride) {
    for (int j = stride / 2; j < cells; j += stride) {
      const int id = labels[static_cast<std::size_t>(i * cells + j)];
      if (id < 0) continue;
      const Region& region = map.regions[static_cast<std::size_t>(id)];
      if (region.kind == RegionKind::kUnreachable) continue;
      const SurfaceJet jet = Evaluate(piece, (i + 0.5) / cells, (j + 0.5) / cells);
      const auto e = UpwardNormal(jet);
      if (!e) continue;
      const RegionChoice& choice = choices[static_cast<std::size_t>(id)];
      const auto across =
          ByContours(choice, region) ? AcrossContours(*e) : AcrossLines(*e, choice.zigzag_angle);
      if (!across) continue;
      const double step = CenterStep(radius, choice.scallop, NormalCurvature(Forms(jet, *e), jet, *across));
      if (step > 0.0) steps[static_cast<std::size_t>(id)].Add(step);
    }
  }
  return steps;
}

}  // namespace

absl::Status FillSteps(const Surface& surface, const std::vector<RegionChoice>& choices,
                       const Resolved& resolved, const RunContext& run, RegionMap& map) {
  const double points = static_cast<double>(map.cells) * map.cells * static_cast<double>(map.labels.size());
  const int stride =
      std::clamp(static_cast<int>(std::ceil(std::sqrt(points / kMostPoints))), 1, std::max(1, map.cells));
  std::vector<std::vector<Range>> pieces(surface.pieces.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, pieces.size(), [&](std::size_t i) {
    pieces[i] =
        PieceSteps(surface.pieces[i], map.labels[i], map.cells, stride, map, choices, resolved.plan_radius);
  }));
  for (Region& region : map.regions) {
    Range all;
    for (const auto& piece : pieces) all.Add(piece[static_cast<std::size_t>(region.id)]);
    region.step_min = all.max > 0.0 ? all.min : 0.0;
    region.step_max = all.max;
  }
  return absl::OkStatus();
}

}  // namespace patchmill
