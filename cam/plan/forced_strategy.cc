#include "cam/plan/forced_strategy.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "cam/path/reach/forced_steps.h"
#include "cam/path/stepover/pass_params.h"
#include "cam/plan/region_choices.h"
#include "cam/plan/region_points.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/spatial/point_cells.h"
#include "core/surface/surface.h"

namespace patchmill {
namespace {

constexpr std::size_t kMostPlaces = 20'000;  // of a region
// Around so many of the deepest places of a region the surface is sampled again, this often each way.
constexpr std::size_t kDeepest = 32;
constexpr int kAround = 9;

struct ForcedPlace {
  RegionId region;
  SurfacePoint at;
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
      pieces[i].beyond.push_back({at.region,
                                  {PieceId(i), at.u, at.v, at.jet.p},
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

// What stays at a place: at most what the least step leaves, and at most the distance to a ball that touches
// finished surface.
class Leftover {
 public:
  Leftover(const JobContext& context, const std::vector<Vec3>& centers)
      : centers_(centers),
        radius_(context.resolved.plan_radius),
        farthest_(context.surface.box.Diagonal()),
        finished_(centers, radius_) {}

  double At(const Vec3& p, double by_step) const {
    const auto nearest = finished_.Nearest(p);
    const double away = nearest ? (centers_[*nearest] - p).norm() : farthest_;
    return std::min(by_step, away - radius_);
  }

 private:
  const std::vector<Vec3>& centers_;
  double radius_, farthest_;
  PointCells finished_;
};

// The largest leftover around a place, within the cell of the surface that the place stands for.
double DeepestAround(const JobContext& context, const RegionChoice& choice, double cell,
                     const Leftover& leftover, const ForcedPlace& place) {
  const double radius = context.resolved.plan_radius;
  double deepest = place.left;
  for (int i = 0; i < kAround; ++i) {
    for (int j = 0; j < kAround; ++j) {
      const auto in_cell = [&](double middle, int k) {
        return std::clamp(middle + cell * ((k + 0.5) / kAround - 0.5), 0.0, 1.0);
      };
      const SurfaceJet jet =
          Evaluate(context.surface, place.at.piece, in_cell(place.at.u, i), in_cell(place.at.v, j));
      const auto e = UpwardNormal(jet);
      if (!e) continue;
      const double by_step =
          LeftByStep(ForcedOf(choice), jet, *e, {radius, choice.scallop}, PassParams().min_step_fraction);
      deepest = std::max(deepest, leftover.At(jet.p, by_step));
    }
  }
  return deepest;
}

// The deepest places of each region, at most kDeepest of each.
std::vector<ForcedPlace> DeepestPlaces(std::vector<ForcedPlace> places) {
  std::stable_sort(places.begin(), places.end(), [](const ForcedPlace& a, const ForcedPlace& b) {
    return std::pair(a.region, -a.left) < std::pair(b.region, -b.left);
  });
  std::vector<ForcedPlace> deepest;
  std::size_t of_region = 0;
  for (const ForcedPlace& place : places) {
    of_region = !deepest.empty() && deepest.back().region == place.region ? of_region + 1 : 0;
    if (of_region < kDeepest) deepest.push_back(place);
  }
  return deepest;
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
  const Leftover leftover(context, seen.centers);
  PM_RETURN_IF_ERROR(ParallelFor(context.run, nullptr, seen.beyond.size(), [&](std::size_t k) {
    ForcedPlace& place = seen.beyond[k];
    place.left = leftover.At(place.at.p, place.left);
  }));
  std::vector<ForcedPlace> deepest = DeepestPlaces(std::move(seen.beyond));
  const double cell = StrideOf(map) / static_cast<double>(map.cells);
  PM_RETURN_IF_ERROR(ParallelFor(context.run, nullptr, deepest.size(), [&](std::size_t k) {
    ForcedPlace& place = deepest[k];
    place.left = DeepestAround(context, chosen.choices[place.region.index()], cell, leftover, place);
  }));
  for (const ForcedPlace& place : deepest) {
    Region& region = map.regions[place.region.index()];
    region.deepest_leftover = std::max(region.deepest_leftover, place.left);
  }
  return map;
}

}  // namespace patchmill
