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

// Every how many cells of the map a point is taken, each way.
int StrideOf(const RegionMap& map) {
  const double points = static_cast<double>(map.cells) * map.cells * static_cast<double>(map.labels.size());
  return std::clamp(static_cast<int>(std::ceil(std::sqrt(points / kMostPoints))), 1, std::max(1, map.cells));
}

// Calls visit(region id, jet, upward unit normal) at the points of reachable regions.
template <class Visit>
void VisitPiece(const Surface& surface, std::size_t piece, const RegionMap& map, int stride,
                const Visit& visit) {
  for (int i = stride / 2; i < map.cells; i += stride) {
    for (int j = stride / 2; j < map.cells; j += stride) {
      const int id = map.labels[piece][static_cast<std::size_t>(i * map.cells + j)];
      if (id < 0 || map.regions[static_cast<std::size_t>(id)].kind == RegionKind::kUnreachable) continue;
      const SurfaceJet jet = Evaluate(surface.pieces[piece], (i + 0.5) / map.cells, (j + 0.5) / map.cells);
      if (const auto e = UpwardNormal(jet)) visit(static_cast<std::size_t>(id), jet, *e);
    }
  }
}

}  // namespace

absl::Status FillSteps(const Surface& surface, const std::vector<RegionChoice>& choices,
                       const Resolved& resolved, const RunContext& run, RegionMap& map) {
  const int stride = StrideOf(map);
  std::vector<std::vector<Range>> pieces(surface.pieces.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, pieces.size(), [&](std::size_t i) {
    pieces[i].resize(map.regions.size());
    VisitPiece(surface, i, map, stride, [&](std::size_t id, const SurfaceJet& jet, const Vec3& e) {
      const RegionChoice& choice = choices[id];
      const auto across =
          ByContours(choice, map.regions[id]) ? AcrossContours(e) : AcrossLines(e, choice.zigzag_angle);
      if (!across) return;
      const double step =
          CenterStep(resolved.plan_radius, choice.scallop, NormalCurvature(Forms(jet, e), jet, *across));
      if (step > 0.0) pieces[i][id].Add(step);
    });
  }));
  for (Region& region : map.regions) {
    Range all;
    for (const auto& piece : pieces) all.Add(piece[static_cast<std::size_t>(region.id)]);
    region.step_min = all.max > 0.0 ? all.min : 0.0;
    region.step_max = all.max;
  }
  return absl::OkStatus();
}

absl::StatusOr<double> LeastFeed(const Surface& surface, const std::vector<RegionChoice>& choices,
                                 const Resolved& resolved, const RunContext& run, const RegionMap& map) {
  const int stride = StrideOf(map);
  const double radius = resolved.plan_radius;
  std::vector<double> pieces(surface.pieces.size(), 0.0);
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, pieces.size(), [&](std::size_t i) {
    VisitPiece(surface, i, map, stride, [&](std::size_t id, const SurfaceJet& jet, const Vec3& e) {
      if (choices[id].skip || !IsWanted(resolved.containment, surface.pieces[i].patch, jet.p)) return;
      const PrincipalCurvatures k = Principal(Forms(jet, e));
      const double step = CenterStep(radius, choices[id].scallop, k.k_min);
      if (!(k.k_max * radius < 1.0) || !(step > 0.0)) return;
      const double centers = (1.0 - k.k_min * radius) * (1.0 - k.k_max * radius);
      pieces[i] += jet.du.cross(jet.dv).norm() * centers / step;
    });
  }));
  double sum = 0.0;
  for (const double piece : pieces) sum += piece;
  // Strides need not divide the cells: every point stands for an equal share of its piece.
  const int points = (map.cells - stride / 2 + stride - 1) / stride;
  return sum / (static_cast<double>(points) * points);
}

}  // namespace patchmill
