#include "cam/plan/region_steps.h"

#include <algorithm>
#include <cmath>

#include "cam/path/across_feed.h"
#include "cam/path/cell_reach.h"
#include "cam/path/forced_steps.h"
#include "cam/path/pass_params.h"
#include "cam/path/spacing.h"
#include "cam/plan/region_points.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/diffgeo/forms.h"

namespace patchmill {
namespace {

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

// mm of passes per mm2 of ground, for a ball on the side of the normal e; 0 where it does not fit.
double PassesPerArea(const SurfaceJet& jet, const Vec3& e, double radius, double scallop) {
  const PrincipalCurvatures k = Principal(Forms(jet, e));
  const double step = CenterStep(radius, scallop, k.k_min);
  if (!(k.k_max * radius < 1.0) || !(step > 0.0)) return 0.0;
  return (1.0 - k.k_min * radius) * (1.0 - k.k_max * radius) / step;
}

// Is the ball free beside upright ground, on the side of e? Off it by more than rounding.
bool HasRoom(const Locator& locator, const Vec3& p, const Vec3& e) {
  constexpr double kOff = 1e-6;  // mm
  return locator.Free(p + (locator.radius() + kOff) * e);
}

}  // namespace

absl::Status FillSteps(const Surface& surface, const std::vector<RegionChoice>& choices,
                       const Resolved& resolved, const RunContext& run, RegionMap& map) {
  const int stride = StrideOf(map);
  const auto reachable = [&](std::size_t id) { return map.regions[id].kind != RegionKind::kUnreachable; };
  std::vector<std::vector<Range>> pieces(surface.pieces.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, pieces.size(), [&](std::size_t i) {
    pieces[i].resize(map.regions.size());
    VisitPiece(surface, i, map, stride, reachable,
               [&](std::size_t id, std::size_t, const SurfaceJet& jet, const Vec3& e) {
                 const RegionChoice& choice = choices[id];
                 const auto across = ByContours(choice, map.regions[id])
                                         ? AcrossContours(e)
                                         : AcrossLines(e, LineAt(choice, jet.p));
                 if (!across) return;
                 const double step = CenterStep(resolved.plan_radius, choice.scallop,
                                                NormalCurvature(Forms(jet, e), jet, *across));
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

absl::StatusOr<double> LeastFeed(const Locator& locator, const std::vector<RegionChoice>& choices,
                                 const Resolved& resolved, const RunContext& run, const RegionMap& map) {
  const Surface& surface = locator.surface();
  const int stride = StrideOf(map);
  const auto reachable = [&](std::size_t id) { return map.regions[id].kind != RegionKind::kUnreachable; };
  const double radius = resolved.plan_radius;
  std::vector<double> pieces(surface.pieces.size(), 0.0);
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, pieces.size(), [&](std::size_t i) {
    VisitPiece(surface, i, map, stride, reachable,
               [&](std::size_t id, std::size_t, const SurfaceJet& jet, const Vec3& e) {
                 if (choices[id].skip || !IsWanted(resolved.containment, surface.pieces[i].patch, jet.p))
                   return;
                 const RegionChoice& choice = choices[id];
                 // Forced passes leave that as STRATEGY.
                 if (NeededStepOfSides(ForcedOf(choice), jet, e, radius, choice.scallop) <
                     PassParams().min_step_fraction)
                   return;
                 double passes = PassesPerArea(jet, e, radius, choice.scallop);
                 if (e.z() <= kUprightFace) {
                   const double beyond = PassesPerArea(jet, -e, radius, choice.scallop);
                   const bool here = HasRoom(locator, jet.p, e), there = HasRoom(locator, jet.p, -e);
                   passes = here == there ? std::min(passes, beyond) : here ? passes : beyond;
                 }
                 pieces[i] += jet.du.cross(jet.dv).norm() * passes;
               });
  }));
  double sum = 0.0;
  for (const double piece : pieces) sum += piece;
  return sum * ShareOfPoint(map, stride);
}

}  // namespace patchmill
