#include "cam/path/rest/leftover_spots.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "cam/limits/reach_tolerance.h"
#include "cam/path/chord/chord_bounds.h"
#include "cam/path/edge/sheet_border.h"
#include "cam/path/stepover/step_over.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/diffgeo/forms.h"
#include "core/surface/net_kernel.h"

namespace patchmill {
namespace {

// What was found near a rectangle: a move, by tree and index, and surface points in the ball's way. The
// search of the rectangle's parts starts from it.
struct NearMove {
  std::size_t tree = 0;
  std::int32_t segment = -1;
  double distance = kInfinity;
};
struct Nearby {
  NearMove move;
  Blockers blockers;
};

// A rectangle with its net, made by `depth` halvings.
struct Part {
  SurfaceRect rect;
  NetShape shape;
  const Vec4* net = nullptr;
  int depth = 0;
};

// Control points of a rectangle, in whose convex hull it lies.
using Hull = std::span<const Vec3>;

// Sizes of rectangles, and distances, in flat step-overs.
constexpr double kCoarse = 0.25;   // larger rectangles are not judged by their middles
constexpr double kPair = 1.0;      // larger rectangles lie over more than two moves
constexpr double kFinest = 0.002;  // smaller rectangles are left, and narrower strips beside silhouettes
constexpr double kLimit = 0.05;    // smallest rectangle at a limit of the operation, if a move is at hand
constexpr double kFarFromMoves =
    1.0;  // a move is at hand up to this distance; beyond it the ball may have room only in a narrow gap

// Share of ReachTolerance: a place this near to the limit of reach is not called out of reach. The verifier
// knows reach to 0.02 of it.
constexpr double kProofOfReach = 0.5 * kReachMargin;

// Share of the interval between the two margins, used where a ball that almost fits stands in a hollow that
// is almost round. There all obstacles are equally near.
constexpr double kProofBetween = 0.2;

// Surface that needs steps up to this factor above the shortest may be left to forced passes or not.
constexpr double kForcedMargin = 1.05;

class SpotFinder {
 public:
  SpotFinder(const RestLocators& locators, const std::vector<const SegmentTree*>& trees,
             const RestPassParams& params, const RunContext& run)
      : surface_(locators.ball.surface()),
        reach_(locators.reach),
        trees_(trees),
        params_(params),
        run_(run),
        radius_(locators.ball.radius()),
        flat_(CenterStep(locators.ball.radius(), params.pass.scallop, 0.0)),
        covered_(radius_ + params.limit + params.margin.value_or(kProofMargin * params.tolerance)),
        covered2_(covered_ * covered_),
        lowest_center_(params.pass.floor_z + radius_ -
                       (1.0 + kReachMargin) * ReachTolerance(params.tolerance)),
        cell_reach_{.radius = radius_,
                    .reach_tolerance = (1.0 + kProofOfReach) * ReachTolerance(params.tolerance),
                    .floor_z = params.pass.floor_z + radius_,
                    .narrow = kFinest * flat_},
        near_reach_(cell_reach_) {
    near_reach_.proof = kProofBetween * (kReachMargin - kProofOfReach) * ReachTolerance(params.tolerance);
  }

  void Search(const SurfaceRect& rect, std::vector<LeftoverSpot>& out) const;

 private:
  void Visit(const Part& part, const Nearby& hint, std::vector<LeftoverSpot>& out) const;
  NearMove NearestTo(const Vec3& p, double limit, const NearMove& hint) const;
  double RemovedDistance(const Vec3& p, double size) const;
  bool RemovedLeftLess(const Vec3& p, const NearMove& nearest) const {
    return RemovedDistance(p, 0.0) < nearest.distance - params_.removed_margin;
  }
  std::optional<bool> BendsAlongU(const RectPlaces& places) const;
  bool SplitAlongU(const Vec3& du, const Vec3& dv, const Vec3& p, Hull hull, const NearMove& near) const;
  bool Covered(Hull hull, const NearMove& move) const;
  bool CoveredByTwo(Hull hull, const Vec3& e, const NearMove& move) const;
  bool Required(const SurfaceJet& jet, const Vec3& e) const;
  std::optional<Vec3> ReachableSide(const SurfaceJet& jet, const Vec3& e) const;
  bool Wanted(const SurfacePoint& at) const {
    return params_.operation_limits == nullptr || params_.operation_limits->Wants(at);
  }
  SidesRuledOut ForbiddenSides(const RectPlaces& places) const;
  std::optional<LeftoverSpot> SpotAt(const SurfaceRect& rect, const SurfaceJet& jet, const SurfacePoint& at,
                                     const Vec3& e, const NearMove& nearest) const;
  void AddCorner(const SurfaceRect& rect, std::vector<LeftoverSpot>& out) const;

  const Surface& surface_;
  const Locator& reach_;
  const std::vector<const SegmentTree*>& trees_;
  const RestPassParams& params_;
  const RunContext& run_;
  const double radius_;
  const double flat_;
  const double covered_, covered2_;  // mm from a move, and its square
  const double lowest_center_;       // mm: lowest centre that counts as reached
  CellReachParams cell_reach_, near_reach_;
};

NearMove SpotFinder::NearestTo(const Vec3& p, double limit, const NearMove& hint) const {
  NearMove best{0, -1, limit};
  for (std::size_t t = 0; t < trees_.size(); ++t) {
    const std::int32_t known = hint.segment >= 0 && hint.tree == t ? hint.segment : -1;
    const SegmentTree::Nearest n = trees_[t]->FindNearest(p, best.distance, known);
    if (n.segment >= 0) best = {t, n.segment, n.distance};
  }
  if (best.segment < 0) best.distance = kInfinity;
  return best;
}

// Returns the distance (mm) to the nearest of the moves that were removed. It is infinity where none of these
// finished anything within `size` of p, and 0 where the whole surface counts.
double SpotFinder::RemovedDistance(const Vec3& p, double size) const {
  if (params_.removed == nullptr) return 0.0;
  const SegmentTree::Nearest nearest = params_.removed->FindNearest(p, covered_ + size);
  return nearest.segment < 0 ? kInfinity : nearest.distance;
}

bool SpotFinder::Covered(Hull hull, const NearMove& move) const {
  if (move.segment < 0) return false;
  const PathRuler to_move(trees_[move.tree]->segment(move.segment));
  return std::all_of(hull.begin(), hull.end(),
                     [&](const Vec3& p) { return to_move.Distance2(p) <= covered2_; });
}

// Tests the crest between two passes: `move`, and the one nearest to the ball over the farthest point.
bool SpotFinder::CoveredByTwo(Hull hull, const Vec3& e, const NearMove& move) const {
  if (move.segment < 0) return false;
  const PathSegment one = trees_[move.tree]->segment(move.segment);
  const PathRuler to_move(one);
  const auto farthest = std::max_element(hull.begin(), hull.end(), [&](const Vec3& p, const Vec3& q) {
    return to_move.Distance2(p) < to_move.Distance2(q);
  });
  const NearMove other = NearestTo(*farthest + radius_ * e, flat_, {});
  if (other.segment < 0 || (other.tree == move.tree && other.segment == move.segment)) return false;
  return DistanceToEither(one, trees_[other.tree]->segment(other.segment), hull.data(),
                          static_cast<int>(hull.size()), covered_) <= covered_;
}

bool SpotFinder::Required(const SurfaceJet& jet, const Vec3& e) const {
  return NeededStepOfSides(params_.forced, jet, e, {radius_, params_.pass.scallop}) >=
         params_.pass.min_step_fraction;
}

// Returns the normal of the side from which the point can be finished.
std::optional<Vec3> SpotFinder::ReachableSide(const SurfaceJet& jet, const Vec3& e) const {
  const int sides = HasTwoSides(jet, e) ? 2 : 1;
  for (int side = 0; side < sides; ++side) {
    const Vec3 n = side == 0 ? e : Vec3(-e);
    const Vec3 c = jet.p + radius_ * n;
    if (c.z() < lowest_center_ || !reach_.Free(c)) continue;
    if (params_.operation_limits == nullptr || params_.operation_limits->Allows(c)) return n;
  }
  return std::nullopt;
}

// Returns the spot at a place, if it is one. No move is nearer to the place than `nearest`.
std::optional<LeftoverSpot> SpotFinder::SpotAt(const SurfaceRect& rect, const SurfaceJet& jet,
                                               const SurfacePoint& at, const Vec3& e,
                                               const NearMove& nearest) const {
  const double leftover = std::min(nearest.distance - radius_, radius_);
  if (!(leftover > params_.limit && Required(jet, e) && Wanted(at))) return std::nullopt;
  if (!RemovedLeftLess(at.p, nearest)) return std::nullopt;
  const auto side = ReachableSide(jet, e);
  if (!side) return std::nullopt;
  Vec3 center = at.p + radius_ * *side;
  center.z() = std::max(center.z(), params_.pass.floor_z + radius_);
  return LeftoverSpot{at, *side, center, leftover, rect};
}

// Adds a spot at a corner of the rectangle, if there is one.
void SpotFinder::AddCorner(const SurfaceRect& rect, std::vector<LeftoverSpot>& out) const {
  for (const double u : {rect.u0, rect.u1}) {
    for (const double v : {rect.v0, rect.v1}) {
      const SurfaceJet jet = Evaluate(surface_.piece(rect.piece), u, v);
      const auto e = UpwardNormal(jet);
      if (!e) continue;
      auto spot =
          SpotAt(rect, jet, {rect.piece, u, v, jet.p}, *e, NearestTo(jet.p, 2.0 * radius_, NearMove()));
      if (!spot) continue;
      out.push_back(*std::move(spot));
      return;
    }
  }
}

// Returns the sides that look down, or on which the limits of the operation forbid every centre over the
// rectangle.
SidesRuledOut SpotFinder::ForbiddenSides(const RectPlaces& places) const {
  SidesRuledOut ruled_out{};
  if (params_.operation_limits == nullptr || params_.operation_limits->AllowsAll()) return ruled_out;
  const double turn = BendOver(places.n);
  for (std::size_t side = 0; side < 2; ++side) {
    const double sign = side == 0 ? 1.0 : -1.0;
    double highest_normal = -1.0, spread = 0.0, lowest_center = kInfinity, highest_center = -kInfinity;
    std::array<Vec3, 9> c;
    for (std::size_t k = 0; k < 9; ++k) {
      c[k] = places.p[k] + sign * radius_ * places.n[k];
      lowest_center = std::min(lowest_center, c[k].z());
      highest_center = std::max(highest_center, c[k].z());
      highest_normal = std::max(highest_normal, sign * places.n[k].z());
      spread = std::max(spread, (c[k] - places.p[8] - sign * radius_ * places.n[8]).norm());
    }
    const double bend = BendOver(c);
    ruled_out[side] =
        places.sides.RulesOut(sign, highest_normal + turn) ||
        params_.operation_limits->TooHigh(lowest_center - bend) ||
        params_.operation_limits->Forbids(c[8], spread + bend, highest_center - c[8].z() + bend);
  }
  return ruled_out;
}

// Returns, where the centres bend too much for OutOfReach, whether they bend the most along u. So a tight
// fillet is cut along itself into strips, not into small pieces.
std::optional<bool> SpotFinder::BendsAlongU(const RectPlaces& places) const {
  double along_u = 0.0, along_v = 0.0;
  bool bent = false;
  for (const double sign : {1.0, -1.0}) {
    std::array<Vec3, 9> c;
    for (std::size_t k = 0; k < 9; ++k) c[k] = places.p[k] + sign * radius_ * places.n[k];
    const auto off = [&](std::size_t middle, std::size_t a, std::size_t b) {
      return (c[middle] - 0.5 * (c[a] + c[b])).norm();
    };
    bent = bent || TooBent(c, places.size);
    along_u = std::max({along_u, off(4, 0, 1), off(5, 2, 3), off(8, 6, 7)});
    along_v = std::max({along_v, off(6, 0, 2), off(7, 1, 3), off(8, 4, 5)});
  }
  if (!bent) return std::nullopt;
  return along_u >= along_v;
}

// Chooses the direction in which the farthest point of the hull leaves the move's reach: across the move, or
// along it past its end.
bool SpotFinder::SplitAlongU(const Vec3& du, const Vec3& dv, const Vec3& p, Hull hull,
                             const NearMove& near) const {
  const double lu = du.norm(), lv = dv.norm();
  // Ratio of the sides beyond which the longer one is halved.
  constexpr double kSlender = 6.0;
  if (near.segment < 0 || lu > kSlender * lv || lv > kSlender * lu) return lu >= lv;
  const PathSegment s = trees_[near.tree]->segment(near.segment);
  const auto off = [&](const Vec3& x) -> Vec3 {
    const Vec3 d = s.b - s.a;
    const double l2 = d.squaredNorm();
    return x - s.a - (l2 > 0.0 ? std::clamp((x - s.a).dot(d) / l2, 0.0, 1.0) : 0.0) * d;
  };
  Vec3 worst = off(p);
  for (const Vec3& x : hull) {
    const Vec3 o = off(x);
    if (o.squaredNorm() > worst.squaredNorm()) worst = o;
  }
  const Vec3 grows = worst - off(p);
  return std::abs(du.dot(grows)) >= std::abs(dv.dot(grows));
}

void SpotFinder::Visit(const Part& part, const Nearby& hint, std::vector<LeftoverSpot>& out) const {
  if (run_.Cancelled()) return;
  const SurfaceRect& rect = part.rect;
  std::array<Vec3, kMaxNetPoints> points;
  const Hull hull(points.data(), static_cast<std::size_t>(HullPoints(part.shape, part.net, points.data())));
  const double u = 0.5 * (rect.u0 + rect.u1), v = 0.5 * (rect.v0 + rect.v1);
  const SurfaceJet jet = Evaluate(surface_.piece(rect.piece), u, v);
  const Vec3& p = jet.p;
  const SurfacePoint at{rect.piece, u, v, p};
  const auto regular = UpwardNormal(jet);
  const Vec3 e = regular ? *regular : UpwardNormalNear(surface_, at);
  double size = 0.0;  // all of the rectangle lies within this distance of p
  for (const Vec3& x : hull) size = std::max(size, (x - p).norm());

  if (RemovedDistance(p, size) == kInfinity) return;
  if (params_.operation_limits != nullptr &&
      params_.operation_limits->WantsNothing(at, {rect.u0, rect.u1, rect.v0, rect.v1}, size)) {
    return;
  }
  // The move that covers most of the rectangle passes near the centre that finishes p. Only small rectangles
  // deserve the costlier search around p itself, which is also right where the normal turns quickly.
  Nearby found{{}, hint.blockers};
  NearMove& near = found.move;
  if (size < 4.0 * flat_) {
    near = NearestTo(p + radius_ * e, flat_, hint.move);
    if (Covered(hull, near)) return;
    if (size < kPair * flat_ && CoveredByTwo(hull, e, near)) return;
  }
  if (size < kCoarse * flat_) {
    const NearMove nearest = NearestTo(p, 2.0 * radius_, near);
    if (Covered(hull, nearest)) return;
    if (auto spot = SpotAt(rect, jet, at, e, nearest)) {
      out.push_back(*std::move(spot));
      return;
    }
    if (params_.coarse_where_both_exceed && nearest.distance - radius_ > params_.limit &&
        !RemovedLeftLess(p, nearest)) {
      AddCorner(rect, out);
      return;
    }
  }
  // Most halvings of a rectangle.
  constexpr int kDeepest = 60;
  const bool limited = params_.operation_limits != nullptr &&
                       !(Wanted(at) && params_.operation_limits->Allows(p + radius_ * e));
  const bool at_hand = near.segment >= 0 && near.distance < radius_ + kFarFromMoves * flat_;
  // The verifier ignores places within ReachTolerance of a limit, measured along the surface
  // ([regions, section 6]). Of the sharpest corner the rest shows at the corners of rectangles of this size.
  const double finest =
      limited && at_hand ? std::min(kLimit * flat_, ReachTolerance(params_.tolerance)) : kFinest * flat_;
  if (size < finest || part.depth >= kDeepest) {
    // The reachable part may be narrower than this: the floor of a slot that barely admits the ball, along
    // its middle, or a sharp corner between two limits.
    if (limited || near.segment < 0) AddCorner(rect, out);
    return;
  }
  if (size < 8.0 * flat_ && NeedsShorterSteps(params_.forced, surface_, rect, {radius_, params_.pass.scallop},
                                              kForcedMargin * params_.pass.min_step_fraction)) {
    return;
  }
  // Larger rectangles with a pass nearby have reachable surface.
  std::optional<bool> bends;
  if (size < (near.segment < 0 ? 8.0 : kCoarse) * flat_) {
    const auto places = PlacesOn(surface_, rect, size);
    if (places && OutOfReach(surface_, *places, size < kCoarse * flat_ ? near_reach_ : cell_reach_,
                             found.blockers, ForbiddenSides(*places))) {
      return;
    }
    if (places && near.segment < 0) bends = BendsAlongU(*places);
  }

  const bool along_u =
      bends ? *bends : SplitAlongU(jet.du * (rect.u1 - rect.u0), jet.dv * (rect.v1 - rect.v0), p, hull, near);
  std::array<Vec4, kMaxNetPoints> low, high;
  HalveNet(part.shape, part.net, along_u, low.data(), high.data());
  SurfaceRect a = rect, b = rect;
  if (along_u) {
    a.u1 = b.u0 = u;
  } else {
    a.v1 = b.v0 = v;
  }
  Visit({a, part.shape, low.data(), part.depth + 1}, found, out);
  Visit({b, part.shape, high.data(), part.depth + 1}, found, out);
}

void SpotFinder::Search(const SurfaceRect& rect, std::vector<LeftoverSpot>& out) const {
  const BernsteinNet& given = surface_.piece(rect.piece).net;
  const NetShape shape{given.degree_u, given.degree_v};
  std::array<Vec4, kMaxNetPoints> net;
  std::copy(given.points.begin(), given.points.end(), net.begin());
  RestrictNet(shape, net.data(), {rect.u0, rect.u1, rect.v0, rect.v1});
  Visit({rect, shape, net.data(), 0}, {}, out);
}

}  // namespace

absl::StatusOr<Locator> ReachLocator(const Locator& locator, const RestPassParams& params,
                                     const RunContext& run) {
  const double radius = locator.radius() - (1.0 + kReachMargin) * ReachTolerance(params.tolerance);
  return Locator::Make(locator.surface(), std::max(radius, 0.5 * locator.radius()), run);
}

absl::StatusOr<std::vector<LeftoverSpot>> FindSpots(const RestLocators& locators,
                                                    const std::vector<const SegmentTree*>& trees,
                                                    const std::vector<SurfaceRect>& rects,
                                                    const RestPassParams& params, const RunContext& run) {
  const SpotFinder finder(locators, trees, params, run);
  // Rectangles per task.
  constexpr std::size_t kChunk = 32;
  const std::size_t chunks = (rects.size() + kChunk - 1) / kChunk;
  std::vector<std::vector<LeftoverSpot>> found(chunks);
  PM_RETURN_IF_ERROR(ParallelFor(run, "coverage: spots", chunks, [&](std::size_t chunk) {
    for (std::size_t i = chunk * kChunk; i < std::min(rects.size(), (chunk + 1) * kChunk); ++i) {
      finder.Search(rects[i], found[chunk]);
    }
  }));
  PM_RETURN_IF_ERROR(run.Check());
  std::vector<LeftoverSpot> spots;
  for (auto& part : found) spots.insert(spots.end(), part.begin(), part.end());
  return spots;
}

}  // namespace patchmill
