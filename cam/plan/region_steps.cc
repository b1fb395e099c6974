#include "cam/plan/region_steps.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>

#include "cam/path/reach/cell_reach.h"
#include "cam/path/reach/forced_steps.h"
#include "cam/path/stepover/across_feed.h"
#include "cam/path/stepover/pass_params.h"
#include "cam/path/stepover/step_over.h"
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

// mm of passes per mm2 of surface, for a ball on the side of the normal e; 0 where it does not fit.
double PassesPerArea(const SurfaceJet& jet, const Vec3& e, double radius, double scallop) {
  const PrincipalCurvatures k = Principal(Forms(jet, e));
  const double step = CenterStep(radius, scallop, k.k_min);
  if (!(k.k_max * radius < 1.0) || !(step > 0.0)) return 0.0;
  return (1.0 - k.k_min * radius) * (1.0 - k.k_max * radius) / step;
}

// The vertical faces of one region on one piece: passes (mm) for a ball on each side, and on which sides
// there is room for a ball anywhere. The sides are those of du x dv.
class VerticalFaces {
 public:
  void Add(const Locator& locator, const SurfaceJet& jet, double scallop) {
    const Vec3 normal = jet.du.cross(jet.dv);
    const double area = normal.norm(), radius = locator.radius();
    const Vec3 e = normal / area;
    const double over = area * PassesPerArea(jet, e, radius, scallop),
                 under = area * PassesPerArea(jet, -e, radius, scallop);
    over_ += over;
    under_ += under;
    least_ += std::min(over, under);
    // Only points whose number is a power of two look for room: next to a hole that the ball just fits one
    // look takes a millisecond.
    if (over == under || !std::has_single_bit(++points_)) return;
    room_over_ = room_over_ || HasRoom(locator, jet.p, e);
    room_under_ = room_under_ || HasRoom(locator, jet.p, -e);
  }
  double Passes() const { return room_over_ == room_under_ ? least_ : room_over_ ? over_ : under_; }

 private:
  // A little off the surface, by more than rounding.
  static bool HasRoom(const Locator& locator, const Vec3& p, const Vec3& e) {
    constexpr double kOff = 1e-6;  // mm
    return locator.Free(p + (locator.radius() + kOff) * e);
  }

  double over_ = 0.0, under_ = 0.0, least_ = 0.0;
  bool room_over_ = false, room_under_ = false;
  std::uint32_t points_ = 0;
};

}  // namespace

namespace {

// By id.
absl::StatusOr<std::vector<double>> SelectedShares(const JobContext& context, const RegionMap& map) {
  const Surface& surface = context.surface;
  const Containment& containment = context.resolved.containment;
  std::vector<double> shares(map.regions.size(), 1.0);
  if (containment.WantsAll()) return shares;
  const RegionPoints points(surface, map);
  struct Areas {
    double all = 0.0, wanted = 0.0;
  };
  std::vector<std::vector<Areas>> pieces(surface.pieces.size());
  PM_RETURN_IF_ERROR(ParallelFor(context.run, nullptr, pieces.size(), [&](std::size_t i) {
    pieces[i].resize(map.regions.size());
    points.VisitPiece(
        i, [](RegionId) { return true; },
        [&](const RegionPoint& at) {
          const double area = at.jet.du.cross(at.jet.dv).norm();
          Areas& areas = pieces[i][at.region.index()];
          areas.all += area;
          if (IsWanted(containment, surface.pieces[i].patch, at.jet.p)) areas.wanted += area;
        });
  }));
  for (std::size_t id = 0; id < map.regions.size(); ++id) {
    Areas sum;
    for (const std::vector<Areas>& piece : pieces) {
      sum.all += piece[id].all;
      sum.wanted += piece[id].wanted;
    }
    if (sum.all > 0.0) shares[id] = sum.wanted / sum.all;
  }
  return shares;
}

// True at a place of a patch that the same pass finishes as the patch whose copy it is.
bool IsCopyOfWanted(const JobContext& context, PatchId patch, const Vec3& p) {
  const auto& originals = context.surface.network.duplicate_of;
  if (originals.empty() || !originals[patch.index()]) return false;  // a network joined by hand has none
  return IsWanted(context.resolved.containment, *originals[patch.index()], p);
}

}  // namespace

absl::StatusOr<std::vector<RegionFigures>> MeasureRegions(const JobContext& context, const RegionMap& map,
                                                          const std::vector<RegionChoice>& choices) {
  const Surface& surface = context.surface;
  const Resolved& resolved = context.resolved;
  PM_ASSIGN_OR_RETURN(const std::vector<double> selected, SelectedShares(context, map));
  const RegionPoints points(surface, map);
  const auto reachable = [&](RegionId id) {
    return map.regions[id.index()].kind != RegionKind::kUnreachable;
  };
  struct Seen {
    Range steps;
    double area = 0.0, otherwise = 0.0;
  };
  const double split = std::cos(resolved.split_angle);
  std::vector<std::vector<Seen>> pieces(surface.pieces.size());
  PM_RETURN_IF_ERROR(ParallelFor(context.run, nullptr, pieces.size(), [&](std::size_t i) {
    pieces[i].resize(map.regions.size());
    points.VisitPiece(i, reachable, [&](const RegionPoint& at) {
      const std::size_t id = at.region.index();
      const SurfaceJet& jet = at.jet;
      const Vec3& e = at.normal;
      Seen& seen = pieces[i][id];
      const RegionChoice& choice = choices[id];
      const bool contours = ByContours(choice, map.regions[id]);
      const double area = jet.du.cross(jet.dv).norm();
      seen.area += area;
      if (choice.strategy == Strategy::kAuto && contours != (e.z() <= split)) seen.otherwise += area;
      const auto across =
          contours ? AcrossContours(e) : AcrossLines(e, LineAt(choice, map.ComponentAt(i, at.cell), jet.p));
      if (!across) return;
      const double step =
          CenterStep(resolved.plan_radius, choice.scallop, NormalCurvature(Forms(jet, e), jet, *across));
      if (step > 0.0) seen.steps.Add(step);
    });
  }));
  std::vector<RegionFigures> figures(map.regions.size());
  for (std::size_t id = 0; id < figures.size(); ++id) {
    Seen all;
    for (const auto& piece : pieces) {
      const Seen& seen = piece[id];
      all.steps.Add(seen.steps);
      all.area += seen.area;
      all.otherwise += seen.otherwise;
    }
    figures[id].step_min = all.steps.max > 0.0 ? all.steps.min : 0.0;
    figures[id].step_max = all.steps.max;
    figures[id].otherwise_share = all.area > 0.0 ? all.otherwise / all.area : 0.0;
    figures[id].selected_share = selected[id];
  }
  return figures;
}

absl::StatusOr<double> LeastCutLength(const JobContext& context, const Locator& locator, const RegionMap& map,
                                      const std::vector<RegionChoice>& choices) {
  const Surface& surface = context.surface;
  const Resolved& resolved = context.resolved;
  const RegionPoints points(surface, map);
  const auto reachable = [&](RegionId id) {
    return map.regions[id.index()].kind != RegionKind::kUnreachable;
  };
  const double radius = resolved.plan_radius;
  std::vector<double> pieces(surface.pieces.size(), 0.0);
  PM_RETURN_IF_ERROR(ParallelFor(context.run, nullptr, pieces.size(), [&](std::size_t i) {
    std::map<RegionId, VerticalFaces> upright;
    const PatchId patch = surface.pieces[i].patch;
    points.VisitPiece(i, reachable, [&](const RegionPoint& at) {
      const SurfaceJet& jet = at.jet;
      const Vec3& e = at.normal;
      const RegionChoice& choice = choices[at.region.index()];
      if (choice.skip || !IsWanted(resolved.containment, patch, jet.p)) return;
      if (IsCopyOfWanted(context, patch, jet.p)) return;
      // Forced passes leave that as STRATEGY.
      if (NeededStepOfSides(ForcedOf(choice), jet, e, {radius, choice.scallop}) <
          PassParams().min_step_fraction)
        return;
      if (HasTwoSides(jet, e)) {
        upright[at.region].Add(locator, jet, choice.scallop);
      } else {
        pieces[i] += jet.du.cross(jet.dv).norm() * PassesPerArea(jet, e, radius, choice.scallop);
      }
    });
    for (const auto& [id, faces] : upright) pieces[i] += faces.Passes();
  }));
  double sum = 0.0;
  for (const double piece : pieces) sum += piece;
  return sum * points.Share();
}

}  // namespace patchmill
