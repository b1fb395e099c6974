#include "cam/plan/forced_strategy.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "cam/path/reach/forced_steps.h"
#include "cam/path/stepover/pass_params.h"
#include "cam/plan/region_choices.h"
#include "cam/plan/region_points.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/spatial/point_cells.h"

namespace patchmill {
namespace {

constexpr std::size_t kMostPlaces = 500;  // of a region

struct ForcedPlace {
  RegionId region;
  Vec3 p = Vec3::Zero();
  double left = 0.0;  // mm, by the least step
};

// What there is to see of forced passes on one piece, or on all.
struct Seen {
  std::vector<ForcedPlace> beyond;  // in regions that are not finished
  std::vector<Vec3> centers;        // mm, of balls that touch what is
};

absl::StatusOr<Seen> Look(const JobContext& context, const RegionMap& map,
                          const std::vector<RegionChoice>& choices) {
  const Surface& surface = context.surface;
  const double radius = context.resolved.plan_radius;
  const auto reached = [&](RegionId id) {
    return map.regions[id.index()].kind != RegionKind::kUnreachable && !choices[id.index()].skip;
  };
  const RegionPoints points(surface, map);
  std::vector<Seen> pieces(surface.pieces.size());
  PM_RETURN_IF_ERROR(ParallelFor(context.run, nullptr, pieces.size(), [&](std::size_t i) {
    points.VisitPiece(i, reached, [&](const RegionPoint& at) {
      if (map.regions[at.region.index()].reason == UnreachableReason::kNone) {
        pieces[i].centers.push_back(at.jet.p + radius * at.normal);
        return;
      }
      const RegionChoice& choice = choices[at.region.index()];
      pieces[i].beyond.push_back({at.region, at.jet.p,
                                  LeftByStep(ForcedOf(choice), at.jet, at.normal, {radius, choice.scallop},
                                             PassParams().min_step_fraction)});
    });
  }));
  Seen all;
  for (Seen& seen : pieces) {
    all.beyond.insert(all.beyond.end(), seen.beyond.begin(), seen.beyond.end());
    all.centers.insert(all.centers.end(), seen.centers.begin(), seen.centers.end());
  }
  return all;
}

}  // namespace

std::function<double(const SurfaceJet&)> FinishedByForced(const Operation& op, double radius) {
  const ForcedSteps forced = ForcedOf(ChoiceOf(op));
  if (forced.passes == ForcedPasses::kNone) return {};
  return [=](const SurfaceJet& jet) {
    const auto e = UpwardNormal(jet);
    return e ? NeededFineStep(forced, jet, *e, radius) - PassParams().min_step_fraction : 0.0;
  };
}

absl::StatusOr<RegionMap> MarkUnfinishedByStrategy(const JobContext& context, RegionMap map,
                                                   const RegionChoices& chosen) {
  const Operation& op = context.job.operation;
  const double radius = context.resolved.plan_radius;
  bool any = false;
  for (Region& region : map.regions) {
    if (region.reason != UnreachableReason::kStrategy) continue;
    const std::size_t id = region.id.index();
    const RegionChoice& choice = chosen.choices[id];
    const bool otherwise =
        choice.strategy != op.strategy || (choice.strategy == Strategy::kZigzag &&
                                           (chosen.open[id].angle || choice.zigzag_angle != op.zigzag_angle));
    if (otherwise) region.reason = UnreachableReason::kNone;
    any = any || !otherwise;
  }
  if (!any) return map;
  PM_ASSIGN_OR_RETURN(Seen seen, Look(context, map, chosen.choices));
  std::vector<std::size_t> places(map.regions.size(), 0), met = places;
  for (const ForcedPlace& place : seen.beyond) ++places[place.region.index()];
  std::erase_if(seen.beyond, [&](const ForcedPlace& place) {
    const std::size_t id = place.region.index();
    return met[id]++ % (1 + places[id] / kMostPlaces) != 0;
  });
  const PointCells finished(seen.centers, radius);
  PM_RETURN_IF_ERROR(ParallelFor(context.run, nullptr, seen.beyond.size(), [&](std::size_t k) {
    ForcedPlace& place = seen.beyond[k];
    const auto nearest = finished.Nearest(place.p);
    const double away = nearest ? (seen.centers[*nearest] - place.p).norm() : context.surface.box.Diagonal();
    place.left = std::min(place.left, away - radius);
  }));
  for (const ForcedPlace& place : seen.beyond) {
    Region& region = map.regions[place.region.index()];
    region.deepest_leftover = std::max(region.deepest_leftover, place.left);
  }
  return map;
}

}  // namespace patchmill
