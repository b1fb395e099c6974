#include "cam/verify/leftover.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "cam/verify/beyond_strategy.h"
#include "core/base/status.h"

namespace patchmill {

namespace {

constexpr double kBorderCell = 0.025;    // of the radius: unreachable cells are not halved below
constexpr double kSteepCell = 0.005;     // the same where the leftover may still rise by more than
constexpr double kBorderRise = 5.0;      // this many times the certainty
constexpr double kListedCell = 0.1;      // the same where only one more violation could be found
constexpr double kSmallestCell = 0.001;  // of the radius: nor any others
constexpr double kStrategyCell = 0.1;    // of the radius: excused cells are judged by their middle
constexpr double kFar = 1.2;             // of the radius
constexpr double kFarSlack = 0.02;
constexpr double kShankProof = 0.02;  // of the give

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

  // The distance that leaves so much.
  double Distance(double leftover) const {
    return params_.most <= leftover ? kInfinity : leftover + params_.reach.radius - params_.chord_error;
  }

  // How small an unreachable cell must be to be left at the border of the reachable set.
  double BorderCell(double upper, const Threshold& threshold, const Extreme& here) const {
    const double known = std::max(threshold.known, here.value);
    if (upper <= known) return kListedCell * params_.reach.radius;
    // The steeper the leftover, the more a sample between the last ones could add.
    return (upper - known > kBorderRise * params_.certainty ? kSteepCell : kBorderCell) *
           params_.reach.radius;
  }

  bool Visit(const SurfaceCell& cell, const Threshold& threshold, Extreme& here) {
    if (run_.Cancelled()) return false;
    if (OutsideContacts(cell)) return false;
    // Any move bounds the distance from above: often the last one will do.
    if (hint_ >= 0 && IsDone(cell, hint_, threshold.Drop(here.value))) return false;
    SegmentTree::Nearest nearest;
    std::optional<bool> asked;
    // Far from all cuts and surely unreachable: the common case of an inner wall. No need to know how far.
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

  // The segment alone leaves no more than `enough` on the whole cell.
  bool IsDone(const SurfaceCell& cell, int segment, double enough) const {
    const double reach = Distance(enough);
    if (!(reach >= 0.0)) return false;
    const PathRuler ruler(tree_.segment(segment));
    return std::all_of(cell.hull, cell.hull + cell.hull_count,
                       [&](const Vec3& p) { return ruler.Distance2(p) <= reach * reach; });
  }

  // Upper bound of the distance to the moves over the whole cell; at most one more segment is tried when the
  // nearest one alone does not keep it below what would count.
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

  // No point of the cell is to be finished.
  bool OutsideContacts(const SurfaceCell& cell) const {
    const CellRect& r = cell.rect;
    if (params_.where != nullptr && !params_.where->HasAny(r.piece, r.u0, r.u1, r.v0, r.v1)) return true;
    const Containment* containment = params_.reach.limits.containment;
    return containment != nullptr && ContactRoomOutside(*containment, cell.middle) > cell.radius;
  }

  bool IsAsked(const SurfaceCell& cell) {
    const CellRect& r = cell.rect;
    if (!IsWantedAt(surface_, params_, r.piece, r.u(), r.v(), cell.middle)) return false;
    const SurfaceJet jet = Evaluate(surface_, cell.rect.piece, cell.rect.u(), cell.rect.v());
    const auto facing = FacingAt(jet);
    return facing && IsAskedOn(surface_, {r.piece, r.u(), r.v(), jet.p}, *facing, params_.reach, obstacles_);
  }

  // No point of the cell is reachable, as all centres over it lie below the floor or above the top, or the
  // centre cannot move far enough from the one over its middle. Normals are taken near the corners and
  // widened by a quarter.
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
      if (corner->both || corner->e.dot(facing.e) < 0.0) facing.both = true;  // a silhouette runs through it
      turn = std::max(turn, std::min((corner->e - facing.e).norm(), (corner->e + facing.e).norm()));
    }
    const double spread = cell.radius + 1.25 * turn * params_.reach.radius;
    if (spread > params_.reach.radius) return false;
    if (OutsideHeights(cell, facing, 1.25 * turn)) return true;
    if (UnderShank(cell, facing, 1.25 * turn)) return true;
    return BlockedDepth(surface_, cell.middle, facing, params_.reach, obstacles_) > spread;
  }

  // All centres over the cell are too low or too high. Its normals are within `turn` of the one of `facing`.
  bool OutsideHeights(const SurfaceCell& cell, const Facing& facing, double turn) const {
    const double radius = params_.reach.radius, z = facing.e.z();
    const double highest = std::min(1.0, z + turn),
                 lowest = std::max(-1.0, facing.both ? -std::abs(z) - turn : z - turn);
    const auto [low, high] = std::minmax_element(cell.hull, cell.hull + cell.hull_count,
                                                 [](const Vec3& a, const Vec3& b) { return a.z() < b.z(); });
    if (high->z() + radius * highest < params_.reach.floor_z - params_.reach.reach_tolerance) return true;
    return TopRoomAt(params_.reach.limits, low->z() + radius * lowest) < 0.0;
  }

  // The shank is in the way of all centres over the cell, as flat ground has them at one height.
  bool UnderShank(const SurfaceCell& cell, const Facing& facing, double turn) const {
    const CenterLimits& limits = params_.reach.limits;
    if (!limits.shank) return false;
    const double radius = params_.reach.radius, beside = cell.radius + turn * radius;
    const Vec3* high = std::max_element(cell.hull, cell.hull + cell.hull_count,
                                        [](const Vec3& a, const Vec3& b) { return a.z() < b.z(); });
    for (const Vec3& e : {facing.e, Vec3(-facing.e)}) {
      Vec3 center = cell.middle + radius * e;
      center.z() = high->z() + radius * std::min(1.0, e.z() + turn);
      if (!ShankHitsAll(surface_, limits, center, beside, kShankProof * params_.reach.reach_tolerance))
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

absl::StatusOr<Extremes> FindLeftover(const Surface& surface, const std::vector<CellRect>& roots,
                                      const SegmentTree& tree, const LeftoverParams& params,
                                      const Extreme& known, const RunContext& run) {
  const MakeRootSearch make = [&]() -> RootSearch {
    auto search = std::make_shared<LeftoverSearch>(surface, tree, params, run);
    return
        [search](const CellRect& root, const Threshold& threshold) { return search->Run(root, threshold); };
  };
  return SearchRoots(roots, known, params.limit, params.certainty, make, run, "verify: leftover");
}

}  // namespace patchmill
