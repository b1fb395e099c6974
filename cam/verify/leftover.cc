#include "cam/verify/leftover.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "cam/verify/beyond_strategy.h"
#include "core/base/status.h"

namespace patchmill {

namespace {

constexpr double kBorderCell = 0.025;    // of R: smaller cells with an unreachable middle are not halved
constexpr double kSteepCell = 0.005;     // the same if the leftover may still rise by kBorderRise
constexpr double kBorderRise = 5.0;      // in certainties
constexpr double kListedCell = 0.1;      // the same as kBorderCell if it could only be one more violation
constexpr double kSmallestCell = 0.001;  // of R: no smaller cell is halved
constexpr double kStrategyCell = 0.1;    // of R: smaller cells are excused by their middle (BeyondStrategy)
constexpr double kFar = 1.2;             // of R: cells farther from all moves may be far inside a wall
constexpr double kFarSlack = 0.02;       // relative error of their distances
constexpr double kShankProof = 0.02;     // of the reach tolerance: error of the shank's place

class LeftoverSearch {
 public:
  LeftoverSearch(const Surface& surface, const SegmentTree& tree, const LeftoverParams& params,
                 const RunContext& run)
      : surface_(surface), walker_(surface), tree_(tree), params_(params), run_(run) {}

  Extreme Run(const CellRect& root, const Threshold& threshold) {
    Extreme here;
    walker_.Walk(root, [&](const SurfaceCell& cell) { return Visit(cell, threshold, here); });
    return here;
  }

 private:
  double Leftover(double distance) const {
    return std::min(params_.most, distance + params_.chord_error - params_.reach.radius);
  }

  // The distance from the moves at which this leftover stays, mm.
  double Distance(double leftover) const {
    return params_.most <= leftover ? kInfinity : leftover + params_.reach.radius - params_.chord_error;
  }

  // Radius below which a cell with an unreachable middle is abandoned at the border of the reachable set.
  double BorderCell(double upper, const Threshold& threshold, const Extreme& here) const {
    const double known = std::max(threshold.known, here.value);
    if (upper <= known) return kListedCell * params_.reach.radius;
    // Where the leftover is steep, a place between two samples may have much more left.
    return (upper - known > kBorderRise * params_.certainty ? kSteepCell : kBorderCell) *
           params_.reach.radius;
  }

  bool Visit(const SurfaceCell& cell, const Threshold& threshold, Extreme& here) {
    if (run_.Cancelled()) return false;
    if (OutsideContacts(cell)) return false;
    // Any move is an upper bound for the distance. Often the last one is enough.
    if (hint_ >= 0 && IsDone(cell, hint_, threshold.Drop(here.value))) return false;
    SegmentTree::Nearest nearest;
    std::optional<bool> asked;
    // Cells of inner walls are mostly far from all cuts and certainly unreachable. Their distance need not be
    // known exactly.
    if (hint_ < 0 || tree_.Distance(hint_, cell.middle) > kFar * params_.reach.radius) {
      nearest = tree_.FindNearest(cell.middle, kInfinity, hint_, kFarSlack);
      const double least = Leftover(nearest.distance * (1.0 - kFarSlack));
      if (least > threshold.Floor(here.value) + 0.1 * params_.reach.radius) {
        asked = IsAsked(cell);
        if (!*asked && Closed(cell)) return false;
      }
      hint_ = nearest.segment;
    }
    nearest = tree_.FindNearest(cell.middle, kInfinity, hint_);
    hint_ = nearest.segment;
    const double left = Leftover(nearest.distance);
    const double upper = Leftover(UpperDistance(cell, nearest.segment, threshold.Drop(here.value)));
    if (upper <= threshold.Drop(here.value)) return false;
    if (left > threshold.Floor(here.value)) {
      const SurfaceJet jet = Evaluate(surface_, cell.rect.piece, cell.rect.u(), cell.rect.v());
      const auto facing = FacingAt(jet);
      if (facing && left > params_.limit && BeyondStrategy(jet, *facing, params_)) {
        return cell.radius > kStrategyCell * params_.reach.radius;
      }
      if (!asked) asked = IsAsked(cell);
      if (*asked) {
        const int move = nearest.segment < 0 ? -1 : tree_.segment(nearest.segment).move;
        here = {left, cell.middle, cell.rect.piece, move};
      } else if (cell.radius < BorderCell(upper, threshold, here) || Closed(cell)) {
        return false;
      }
    }
    return upper > threshold.Drop(here.value) && cell.radius > kSmallestCell * params_.reach.radius;
  }

  // True if the segment alone leaves no more than `enough` on the whole cell.
  bool IsDone(const SurfaceCell& cell, int segment, double enough) const {
    const double reach = Distance(enough);
    if (!(reach >= 0.0)) return false;
    const PathRuler ruler(tree_.segment(segment));
    return std::all_of(cell.hull, cell.hull + cell.hull_count,
                       [&](const Vec3& p) { return ruler.Distance2(p) <= reach * reach; });
  }

  // Upper bound for the distance to the moves over the whole cell. If the nearest segment alone leaves more
  // than `enough`, one more segment is tried.
  double UpperDistance(const SurfaceCell& cell, int nearest, double enough) {
    if (nearest < 0) return kInfinity;
    const PathRuler to_nearest(tree_.segment(nearest));
    double one2 = 0.0;
    const Vec3* farthest = cell.hull;
    for (const Vec3* p = cell.hull; p != cell.hull + cell.hull_count; ++p) {
      const double distance2 = to_nearest.Distance2(*p);
      if (distance2 > one2) farthest = p;
      one2 = std::max(one2, distance2);
    }
    const double one = std::sqrt(one2);
    if (Leftover(one) <= enough) return one;
    const auto other = tree_.FindNearest(*farthest, one, other_hint_);
    if (other.segment < 0 || other.segment == nearest) return one;
    other_hint_ = other.segment;
    return std::min(one, DistanceToEither(tree_.segment(nearest), tree_.segment(other.segment), cell.hull,
                                          cell.hull_count, Distance(enough)));
  }

  // True if no point of the cell is to be finished.
  bool OutsideContacts(const SurfaceCell& cell) const {
    const CellRect& r = cell.rect;
    if (params_.where != nullptr && !params_.where->HasAny(r.piece, r.u0, r.u1, r.v0, r.v1)) return true;
    const Containment* containment = params_.reach.limits.containment;
    return containment != nullptr && ContactRoomOutside(*containment, cell.middle) > cell.radius;
  }

  bool IsAsked(const SurfaceCell& cell) {
    const CellRect& r = cell.rect;
    if (!IsWantedAt(surface_, params_, {r.piece, r.u(), r.v(), cell.middle})) return false;
    const SurfaceJet jet = Evaluate(surface_, cell.rect.piece, cell.rect.u(), cell.rect.v());
    const auto facing = FacingAt(jet);
    return facing &&
           IsRequiredOn(surface_, {r.piece, r.u(), r.v(), jet.p}, *facing, params_.reach, obstacles_);
  }

  // True if no point of the cell is reachable: all centres over it lie below the floor or above the top, or
  // the shank blocks them, or the blocker at the middle lies deeper than centres over the cell can move. The
  // spread of normals is sampled near the corners and widened by a quarter.
  bool Closed(const SurfaceCell& cell) {
    const CellRect& r = cell.rect;
    const auto middle = FacingAt(Evaluate(surface_, r.piece, r.u(), r.v()));
    if (!middle) return false;
    Facing facing = *middle;
    double turn = 0.0;
    for (int k = 0; k < 4; ++k) {
      const double s = k / 2 == 0 ? 0.01 : 0.99, t = k % 2 == 0 ? 0.01 : 0.99;
      const auto corner =
          FacingAt(Evaluate(surface_, r.piece, r.u0 + s * (r.u1 - r.u0), r.v0 + t * (r.v1 - r.v0)));
      if (!corner) return false;
      if (corner->both || corner->e.dot(facing.e) < 0.0) facing.both = true;  // a silhouette crosses the cell
      turn = std::max(turn, std::min((corner->e - facing.e).norm(), (corner->e + facing.e).norm()));
    }
    const double spread = cell.radius + 1.25 * turn * params_.reach.radius;
    if (spread > params_.reach.radius) return false;
    if (OutsideHeights(cell, facing, 1.25 * turn)) return true;
    if (UnderShank(cell, facing, 1.25 * turn)) return true;
    return BlockedDepth(surface_, cell.middle, facing, params_.reach, obstacles_) > spread;
  }

  // True if all centres over the cell are too low or too high. Its normals differ from that of `facing` by at
  // most `turn`.
  bool OutsideHeights(const SurfaceCell& cell, const Facing& facing, double turn) const {
    const double radius = params_.reach.radius, z = facing.e.z();
    const double highest = std::min(1.0, z + turn),
                 lowest = std::max(-1.0, facing.both ? -std::abs(z) - turn : z - turn);
    const auto [low, high] = std::minmax_element(cell.hull, cell.hull + cell.hull_count,
                                                 [](const Vec3& a, const Vec3& b) { return a.z() < b.z(); });
    if (high->z() + radius * highest < params_.reach.floor_z - params_.reach.reach_tolerance) return true;
    return TopRoomAt(params_.reach.limits, low->z() + radius * lowest) < 0.0;
  }

  // True if shank or holder blocks all centres over the cell. This is tested with one height for all
  // centres, as over a flat surface.
  bool UnderShank(const SurfaceCell& cell, const Facing& facing, double turn) const {
    const CenterLimits& limits = params_.reach.limits;
    if (limits.uppers.empty()) return false;
    const double radius = params_.reach.radius, beside = cell.radius + turn * radius;
    const Vec3* high = std::max_element(cell.hull, cell.hull + cell.hull_count,
                                        [](const Vec3& a, const Vec3& b) { return a.z() < b.z(); });
    for (const Vec3& e : {facing.e, Vec3(-facing.e)}) {
      Vec3 center = cell.middle + radius * e;
      center.z() = high->z() + radius * std::min(1.0, e.z() + turn);
      if (!UpperPartHitsAll(surface_, limits, center, beside, kShankProof * params_.reach.reach_tolerance))
        return false;
      if (!facing.both) return true;
    }
    return true;
  }

  const Surface& surface_;
  CellWalker walker_;
  const SegmentTree& tree_;
  const LeftoverParams& params_;
  const RunContext& run_;
  Obstacles obstacles_;
  int hint_ = -1, other_hint_ = -1;
};

}  // namespace

absl::StatusOr<Extremes> FindLeftover(const RootedSurface& rooted, const SegmentTree& tree,
                                      const LeftoverParams& params, const Extreme& known,
                                      const RunContext& run) {
  const MakeRootSearch make = [&]() -> RootSearch {
    auto search = std::make_shared<LeftoverSearch>(rooted.surface, tree, params, run);
    return
        [search](const CellRect& root, const Threshold& threshold) { return search->Run(root, threshold); };
  };
  return SearchRoots(rooted.roots, {known, params.limit, params.certainty}, make, run, "verify: leftover");
}

}  // namespace patchmill
