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

// mm of passes per mm2 of ground, for a ball on the side of the normal e; 0 where it does not fit.
double PassesPerArea(const SurfaceJet& jet, const Vec3& e, double radius, double scallop) {
  const PrincipalCurvatures k = Principal(Forms(jet, e));
  const double step = CenterStep(radius, scallop, k.k_min);
  if (!(k.k_max * radius < 1.0) || !(step > 0.0)) return 0.0;
  return (1.0 - k.k_min * radius) * (1.0 - k.k_max * radius) / step;
}

// Upright ground of one region on one piece: passes (mm) for a ball on each side of it, and on which there is
// room for one anywhere; the sides are those of du x dv.
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
    // Few are asked, ever fewer: next to a hole that the ball just fits into an answer takes a millisecond.
    if (over == under || !std::has_single_bit(++points_)) return;
    room_over_ = room_over_ || HasRoom(locator, jet.p, e);
    room_under_ = room_under_ || HasRoom(locator, jet.p, -e);
  }
  double Passes() const { return room_over_ == room_under_ ? least_ : room_over_ ? over_ : under_; }

 private:
  // Off the ground by more than rounding.
  static bool HasRoom(const Locator& locator, const Vec3& p, const Vec3& e) {
    constexpr double kOff = 1e-6;  // mm
    return locator.Free(p + (locator.radius() + kOff) * e);
  }

  double over_ = 0.0, under_ = 0.0, least_ = 0.0;
  bool room_over_ = false, room_under_ = false;
  std::uint32_t points_ = 0;
};

}  // namespace

absl::Status FillSteps(const Surface& surface, const std::vector<RegionChoice>& choices,
                       const Resolved& resolved, const RunContext& run, RegionMap& map) {
  const int stride = StrideOf(map);
  const auto reachable = [&](std::size_t id) { return map.regions[id].kind != RegionKind::kUnreachable; };
  struct Seen {
    Range steps;
    double area = 0.0, otherwise = 0.0;
  };
  const double split = std::cos(resolved.split_angle);
  std::vector<std::vector<Seen>> pieces(surface.pieces.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, pieces.size(), [&](std::size_t i) {
    pieces[i].resize(map.regions.size());
    VisitPiece(surface, i, map, stride, reachable,
               [&](std::size_t id, std::size_t cell, const SurfaceJet& jet, const Vec3& e) {
                 Seen& seen = pieces[i][id];
                 const RegionChoice& choice = choices[id];
                 const bool contours = ByContours(choice, map.regions[id]);
                 const double area = jet.du.cross(jet.dv).norm();
                 seen.area += area;
                 if (choice.strategy == Strategy::kAuto && contours != (e.z() <= split))
                   seen.otherwise += area;
                 const auto across = contours
                                         ? AcrossContours(e)
                                         : AcrossLines(e, LineAt(choice, map.ComponentAt(i, cell), jet.p));
                 if (!across) return;
                 const double step = CenterStep(resolved.plan_radius, choice.scallop,
                                                NormalCurvature(Forms(jet, e), jet, *across));
                 if (step > 0.0) seen.steps.Add(step);
               });
  }));
  for (Region& region : map.regions) {
    Seen all;
    for (const auto& piece : pieces) {
      const Seen& seen = piece[static_cast<std::size_t>(region.id)];
      all.steps.Add(seen.steps);
      all.area += seen.area;
      all.otherwise += seen.otherwise;
    }
    region.step_min = all.steps.max > 0.0 ? all.steps.min : 0.0;
    region.step_max = all.steps.max;
    region.otherwise_share = all.area > 0.0 ? all.otherwise / all.area : 0.0;
  }
  return absl::OkStatus();
}

absl::StatusOr<double> LeastCutLength(const Locator& locator, const std::vector<RegionChoice>& choices,
                                      const Resolved& resolved, const RunContext& run, const RegionMap& map) {
  const Surface& surface = locator.surface();
  const int stride = StrideOf(map);
  const auto reachable = [&](std::size_t id) { return map.regions[id].kind != RegionKind::kUnreachable; };
  const double radius = resolved.plan_radius;
  std::vector<double> pieces(surface.pieces.size(), 0.0);
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, pieces.size(), [&](std::size_t i) {
    std::map<std::size_t, VerticalFaces> upright;  // by region
    VisitPiece(surface, i, map, stride, reachable,
               [&](std::size_t id, std::size_t, const SurfaceJet& jet, const Vec3& e) {
                 if (choices[id].skip || !IsWanted(resolved.containment, surface.pieces[i].patch, jet.p))
                   return;
                 const RegionChoice& choice = choices[id];
                 // Forced passes leave that as STRATEGY.
                 if (NeededStepOfSides(ForcedOf(choice), jet, e, radius, choice.scallop) <
                     PassParams().min_step_fraction)
                   return;
                 if (HasTwoSides(jet, e)) {
                   upright[id].Add(locator, jet, choice.scallop);
                 } else {
                   pieces[i] += jet.du.cross(jet.dv).norm() * PassesPerArea(jet, e, radius, choice.scallop);
                 }
               });
    for (const auto& [id, ground] : upright) pieces[i] += ground.Passes();
  }));
  double sum = 0.0;
  for (const double piece : pieces) sum += piece;
  return sum * ShareOfPoint(map, stride);
}

absl::Status FillWantedShares(const Surface& surface, const Containment& containment, const RunContext& run,
                              RegionMap& map) {
  if (containment.WantsAll()) return absl::OkStatus();
  struct Areas {
    double all = 0.0, wanted = 0.0;
  };
  std::vector<std::vector<Areas>> pieces(surface.pieces.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, pieces.size(), [&](std::size_t i) {
    pieces[i].resize(map.regions.size());
    VisitPiece(
        surface, i, map, StrideOf(map), [](std::size_t) { return true; },
        [&](std::size_t id, std::size_t, const SurfaceJet& jet, const Vec3&) {
          const double area = jet.du.cross(jet.dv).norm();
          pieces[i][id].all += area;
          if (IsWanted(containment, surface.pieces[i].patch, jet.p)) pieces[i][id].wanted += area;
        });
  }));
  for (std::size_t id = 0; id < map.regions.size(); ++id) {
    Areas sum;
    for (const std::vector<Areas>& piece : pieces) {
      sum.all += piece[id].all;
      sum.wanted += piece[id].wanted;
    }
    map.regions[id].wanted_share = sum.all > 0.0 ? sum.wanted / sum.all : 1.0;
  }
  return absl::OkStatus();
}

}  // namespace patchmill
