#include "cam/verify/reach.h"

#include <algorithm>
#include <vector>

#include "cam/limits/reach_tolerance.h"
#include "core/surface/closest.h"
#include "core/surface/highest.h"

namespace patchmill {

namespace {

constexpr double kBesideRadii = 0.02;     // in R: distance of the places beside a place
constexpr double kProof = 0.02;           // of the reach tolerance: error of distances that decide "free"
constexpr double kCoarse = 0.02;          // in R: error of a blocked depth
constexpr double kOverhangMargin = 0.02;  // in R: T must be below B by this much [regions U1]
// In radii of the smallest ball: an overhang above it counts if it is nearer to its axis [regions (7)].
constexpr double kAboveSmallestBall = 0.5;
constexpr double kLimitSlack = 1e-6;    // mm; rounding of limits that run along the surface
constexpr double kReasonProof = 0.001;  // in R: error of T and B

// Up to four places of the piece about kBesideRadii away in both parameters. Near its sides there are fewer.
std::vector<SurfaceJet> Beside(const Surface& surface, const SurfacePoint& at, double radius) {
  const SurfaceJet here = Evaluate(surface, at.piece, at.u, at.v);
  const double aside = kBesideRadii * radius;
  const double du = aside / std::max(here.du.norm(), 4.0 * aside),
               dv = aside / std::max(here.dv.norm(), 4.0 * aside);
  std::vector<SurfaceJet> places;
  for (int k = 0; k < 4; ++k) {
    const double u = at.u + (k / 2 == 0 ? du : -du), v = at.v + (k % 2 == 0 ? dv : -dv);
    if (u < 0.0 || u > 1.0 || v < 0.0 || v > 1.0) continue;
    places.push_back(Evaluate(surface, at.piece, u, v));
  }
  return places;
}

std::array<Vec3, 2> Centers(const Vec3& p, const Facing& facing, double radius) {
  return {p + radius * facing.e, p - radius * facing.e};
}

bool NearAvoided(const CenterLimits& limits, const Vec3& c, double proof) {
  return limits.avoided != nullptr &&
         AnythingNearUpwardRay(*limits.avoided, c, limits.avoid_distance + limits.within, proof);
}

// True if all limits but those beside the part allow the centre.
bool AllowsBesidePart(const Surface& surface, const Vec3& c, const ReachParams& params) {
  const double proof = kProof * params.reach_tolerance;
  return RoomAt(params.limits, c) >= 0.0 && !NearAvoided(params.limits, c, proof) &&
         !UpperPartHitsAll(surface, params.limits, c, 0.0, proof);
}

Vec3 FromRay(const Vec3& p, const Vec3& c) {
  return {p.x() - c.x(), p.y() - c.y(), std::min(p.z() - c.z(), 0.0)};
}

// As ClosestToUpwardRay, but a known obstacle may be returned as the nearest point, within `tolerance`.
std::optional<Obstacles::Near> NearestToRay(const Surface& surface, const Vec3& c, double limit,
                                            double tolerance, Obstacles& obstacles) {
  const auto known = obstacles.NearestToRay(c, limit);
  const auto found = ClosestToUpwardRay(surface, c, known ? known->distance : limit, tolerance);
  if (!found) return known;
  obstacles.Add(found->at.p);
  return Obstacles::Near{found->at.p, found->distance};
}

// True if anything is nearer to the upward ray at c than `limit`. Within `tolerance` of the limit the known
// obstacles may decide.
bool InTheWay(const Surface& surface, const Vec3& c, double limit, double tolerance, Obstacles& obstacles) {
  if (obstacles.NearestToRay(c, limit)) return true;
  const auto found = FirstNearUpwardRay(surface, c, limit, tolerance);
  if (found) obstacles.Add(found->at.p);
  return found.has_value();
}

// False if anything is nearer to c than limit - proof. A known obstacle counts only if it is so near that a
// search would certainly find it.
bool NothingNear(const Surface& surface, const Vec3& c, double limit, double proof, Obstacles& obstacles) {
  if (obstacles.DistanceTo(c, limit) < limit - proof) return false;
  const auto found = ClosestToPoint(surface, c, limit, proof);
  if (found) obstacles.Add(found->at.p);
  return !found;
}

// [regions U1] for a ball of `radius` (mm) that touches the surface: true if an overhang (surface above the
// centre c) is nearer to the axis than `limit` (mm), and nearer than any surface is to c by kOverhangMargin.
// Within the error of the distances a known obstacle may decide.
bool OverhangIsNearer(const Surface& surface, const Vec3& c, double radius, double limit,
                      Obstacles& obstacles) {
  const double proof = kReasonProof * radius, nearer = kOverhangMargin * radius;
  limit = std::min(limit, obstacles.DistanceTo(c, radius) - nearer + proof);
  if (!(limit > 0.0)) return false;
  // Any overhang that fulfils the rule is enough: then the point nearest to the ray fulfils it, too.
  const auto above = obstacles.NearestAbove(c, limit);
  if (above && NothingNear(surface, c, above->distance + nearer, proof, obstacles)) return true;
  const auto nearest = NearestToRay(surface, c, limit, proof, obstacles);
  return nearest && nearest->at.z() > c.z() &&
         NothingNear(surface, c, nearest->distance + nearer, proof, obstacles);
}

// [regions U1, U2] for the tool's ball, which is not free.
bool BlockedAbove(const Surface& surface, const Vec3& c, const ReachParams& params, Obstacles& obstacles) {
  const double limit = params.radius - params.reach_tolerance;
  return OverhangIsNearer(surface, c, params.radius, limit, obstacles) ||
         NothingNear(surface, c, params.radius - 0.5 * params.reach_tolerance,
                     kProof * params.reach_tolerance, obstacles);
}

// [regions U3] for the smallest ball; `least` is its radius, mm.
bool HasOverhangOverSmallest(const Surface& surface, const Vec3& c, double least, Obstacles& obstacles) {
  return MayRiseAbove(surface, c, kAboveSmallestBall * least) &&
         OverhangIsNearer(surface, c, least, kAboveSmallestBall * least, obstacles);
}

// For a place where the ball is free on no side: true for UNDERCUT. On a vertical face U1 or U2 must hold on
// both sides, or U3 on both sides.
bool Undercut(const Surface& surface, const Vec3& p, const Facing& facing, const ReachParams& params,
              Obstacles& obstacles) {
  const auto centers = Centers(p, facing, params.radius);
  if (BlockedAbove(surface, centers[0], params, obstacles) &&
      (!facing.upright || BlockedAbove(surface, centers[1], params, obstacles))) {
    return true;
  }
  const double least = SmallestBallRadius(params.reach_tolerance);
  const auto beside = Centers(p, facing, least);
  return least < params.radius && HasOverhangOverSmallest(surface, beside[0], least, obstacles) &&
         (!facing.upright || HasOverhangOverSmallest(surface, beside[1], least, obstacles));
}

}  // namespace

template <typename Counts>
std::optional<Obstacles::Near> Obstacles::Nearest(const Vec3& c, double limit, const Counts& counts) const {
  std::optional<Near> nearest;
  for (std::size_t k = 0; k < std::min(count_, kKept); ++k) {
    if (!counts(kept_[k])) continue;
    const double distance = FromRay(kept_[k], c).norm();
    if (distance < (nearest ? nearest->distance : limit)) nearest = {kept_[k], distance};
  }
  return nearest;
}

std::optional<Obstacles::Near> Obstacles::NearestToRay(const Vec3& c, double limit) const {
  return Nearest(c, limit, [](const Vec3&) { return true; });
}

std::optional<Obstacles::Near> Obstacles::NearestAbove(const Vec3& c, double limit) const {
  return Nearest(c, limit, [&](const Vec3& p) { return p.z() > c.z(); });
}

double Obstacles::DistanceTo(const Vec3& c, double limit) const {
  for (std::size_t k = 0; k < std::min(count_, kKept); ++k) limit = std::min(limit, (kept_[k] - c).norm());
  return limit;
}

void Obstacles::Add(const Vec3& p) { kept_[count_++ % kKept] = p; }

namespace {

bool HasHolder(const CenterLimits& limits) {
  return !limits.uppers.empty() && limits.uppers.back().part == UpperPart::kHolder;
}

// Returns the limits without those of the holder.
CenterLimits BelowHolder(CenterLimits limits) {
  while (HasHolder(limits)) limits.uppers = limits.uppers.first(limits.uppers.size() - 1);
  return limits;
}

}  // namespace

double RoomAt(const CenterLimits& limits, const Vec3& center) {
  if (limits.containment == nullptr) return kInfinity;
  const Containment& c = *limits.containment;
  const Vec3 tip = center - Vec3(0.0, 0.0, limits.ball);
  double room = BoundaryRoom(c, Xy(center), limits.ball);
  for (const Obstacle& o : c.obstacles) {
    if (!o.of_holder || HasHolder(limits)) room = std::min(room, ObstacleRoom(o, tip, limits.tool));
  }
  return std::min(room - limits.within, TopRoomAt(limits, center.z()));
}

double BesideRoomAt(const CenterLimits& limits, const Vec3& center) {
  if (limits.containment == nullptr) return kInfinity;
  return BesideRoom(*limits.containment, center - Vec3(0.0, 0.0, limits.ball)) - limits.within;
}

double TopRoomAt(const CenterLimits& limits, double center_z) {
  if (limits.containment == nullptr) return kInfinity;
  return TopRoom(*limits.containment, center_z - limits.ball) + kTopSlack;
}

ReachClass ReachAt(const Surface& surface, const Vec3& p, const Facing& facing, const ReachParams& params) {
  Obstacles none;
  return ReachAt(surface, p, facing, params, none);
}

ReachClass ReachAt(const Surface& surface, const Vec3& p, const Facing& facing, const ReachParams& params,
                   Obstacles& obstacles) {
  const double limit = params.radius - params.reach_tolerance;
  const auto centers = Centers(p, facing, params.radius);
  ReachClass reason = ReachClass::kReachable;
  const CenterLimits below = BelowHolder(params.limits);
  for (int side = 0; side < (facing.both ? 2 : 1); ++side) {
    const Vec3& c = centers[static_cast<std::size_t>(side)];
    ReachClass found = ReachClass::kReachable;
    if (InTheWay(surface, c, limit, kProof * params.reach_tolerance, obstacles)) {
      found = ReachClass::kConcave;
    } else if (BesideRoomAt(params.limits, c) < 0.0 && AllowsBesidePart(surface, c, params)) {
      found = ReachClass::kOutside;
    } else if (c.z() < params.floor_z - params.reach_tolerance) {
      found = ReachClass::kFloor;
    } else if (std::min(RoomAt(below, c), BesideRoomAt(params.limits, c)) < 0.0 ||
               NearAvoided(params.limits, c, kProof * params.reach_tolerance)) {
      found = ReachClass::kAvoided;
    } else if (const auto part =
                   UpperPartHitsAll(surface, params.limits, c, 0.0, kProof * params.reach_tolerance)) {
      found = *part == UpperPart::kShank ? ReachClass::kShank : ReachClass::kHolder;
    } else if (RoomAt(params.limits, c) < 0.0) {
      found = ReachClass::kHolder;  // beside a clamp
    }
    if (found == ReachClass::kReachable) return found;
    // If both sides are blocked, the side that is easier to free gives the reason.
    reason = std::max(reason, found);
  }
  // The surface is in the way on all sides.
  if (reason == ReachClass::kConcave && Undercut(surface, p, facing, params, obstacles)) {
    reason = ReachClass::kUndercut;
  }
  return reason;
}

ReachClass ReachOn(const Surface& surface, const SurfacePoint& at, const Facing& facing,
                   const ReachParams& params, Obstacles& obstacles) {
  const ReachClass own = ReachAt(surface, at.p, facing, params, obstacles);
  if (own != ReachClass::kReachable || !facing.both) return own;
  std::optional<ReachClass> beside;
  for (const SurfaceJet& jet : Beside(surface, at, params.radius)) {
    const auto there = FacingAt(jet);
    if (!there) continue;
    const ReachClass found = ReachAt(surface, jet.p, *there, params, obstacles);
    if (found == ReachClass::kReachable) return found;
    beside = beside ? std::max(*beside, found) : found;
  }
  return beside.value_or(own);
}

bool IsRequiredOn(const Surface& surface, const SurfacePoint& at, const Facing& facing,
                  const ReachParams& params, Obstacles& obstacles) {
  if (ReachOn(surface, at, facing, params, obstacles) != ReachClass::kReachable) return false;
  const CenterLimits& limits = params.limits;
  if (limits.avoided == nullptr && limits.uppers.empty() &&
      (limits.containment == nullptr || limits.containment->AllowsAll())) {
    return true;
  }
  ReachParams moved = params;
  moved.limits.within = params.reach_tolerance;
  // The ball is known to be free, so on one side the limits decide without another search for obstacles.
  const double proof = kProof * params.reach_tolerance;
  const Vec3 center = at.p + params.radius * facing.e;
  if (!facing.both && RoomAt(moved.limits, center) >= 0.0 && BesideRoomAt(moved.limits, center) >= 0.0 &&
      !NearAvoided(moved.limits, center, proof) &&
      !UpperPartHitsAll(surface, moved.limits, center, 0.0, proof)) {
    return true;
  }
  if (ReachOn(surface, at, facing, moved, obstacles) == ReachClass::kReachable) return true;
  moved.limits.within = -kLimitSlack;
  const std::vector<SurfaceJet> beside = Beside(surface, at, params.radius);
  return std::all_of(beside.begin(), beside.end(), [&](const SurfaceJet& jet) {
    const auto there = FacingAt(jet);
    return !there || ReachAt(surface, jet.p, *there, moved, obstacles) == ReachClass::kReachable;
  });
}

double RaiseNeeded(const Surface& surface, const Vec3& p, const Facing& facing, const ReachParams& params,
                   const PartRaise& known) {
  const CenterLimits& limits = params.limits;
  const double proof = kProof * params.reach_tolerance;
  const auto holder = std::find_if(limits.uppers.begin(), limits.uppers.end(),
                                   [](const UpperCylinder& c) { return c.part == UpperPart::kHolder; });
  const std::span shanks(limits.uppers.begin(), holder), holders(holder, limits.uppers.end());
  const std::span<const UpperCylinder> raised = known.part == UpperPart::kShank ? shanks : holders;
  if (raised.empty()) return known.by;
  ReachParams slim = params;
  slim.limits.uppers = known.part == UpperPart::kShank ? holders : shanks;
  const auto centers = Centers(p, facing, params.radius);
  double needed = kInfinity;
  for (int side = 0; side < (facing.both ? 2 : 1); ++side) {
    const Facing of_side{side == 0 ? facing.e : Vec3(-facing.e), false};
    if (ReachAt(surface, p, of_side, slim) != ReachClass::kReachable) continue;
    const Vec3& c = centers[static_cast<std::size_t>(side)];
    const Vec2 q = Xy(c);
    double here = known.by;
    const auto raise = [&](const UpperCylinder& cylinder, const Surface& over, double keep) {
      const double bottom = c.z() + cylinder.rise - keep;
      const auto highest = HighestInColumn(over, {q, q, cylinder.radius + keep}, bottom + here, proof);
      if (highest) here = highest->p.z() - bottom + proof;
    };
    for (const UpperCylinder& cylinder : raised) {
      raise(cylinder, surface, limits.upper_keep);
      if (limits.avoided != nullptr) raise(cylinder, *limits.avoided, limits.avoid_distance - limits.ball);
    }
    if (known.part == UpperPart::kHolder && limits.containment != nullptr) {
      const double tip = c.z() - limits.ball;
      for (const Obstacle& o : limits.containment->obstacles) {
        if (o.of_holder) here = std::max(here, LowestTipOver(o, q, limits.tool) - tip);
      }
    }
    needed = std::min(needed, here);
  }
  return needed < kInfinity ? needed : known.by;
}

std::optional<UpperPart> UpperPartHitsAll(const Surface& surface, const CenterLimits& limits,
                                          const Vec3& center, double beside, double proof) {
  const Vec2 q = Xy(center);
  const double margin = limits.avoid_distance - limits.ball + limits.within;
  for (const UpperCylinder& cylinder : limits.uppers) {
    // Whether a surface stands in the cylinder, enlarged by `keep`.
    const auto in_cylinder = [&](const Surface& obstacle, double keep) {
      const Column column{q, q, cylinder.radius + keep - beside};
      return AnyInColumn(obstacle, column, center.z() + cylinder.rise - keep, proof);
    };
    if (in_cylinder(surface, limits.upper_keep + limits.within)) return cylinder.part;
    if (limits.avoided != nullptr && in_cylinder(*limits.avoided, margin)) return cylinder.part;
  }
  return std::nullopt;
}

double BlockedDepth(const Surface& surface, const Vec3& p, const Facing& facing, const ReachParams& params,
                    Obstacles& obstacles) {
  const double limit = params.radius - params.reach_tolerance;
  const auto centers = Centers(p, facing, params.radius);
  double depth = kInfinity;
  for (int side = 0; side < (facing.both ? 2 : 1); ++side) {
    const Vec3& c = centers[static_cast<std::size_t>(side)];
    double here = params.floor_z - params.reach_tolerance - c.z();
    const auto nearest = NearestToRay(surface, c, limit, kCoarse * params.radius, obstacles);
    if (nearest) here = std::max(here, limit - nearest->distance);
    here = std::max(here, -std::min(RoomAt(params.limits, c), BesideRoomAt(params.limits, c)));
    if (params.limits.avoided != nullptr) {
      const double keep = params.limits.avoid_distance;
      const auto avoided = ClosestToUpwardRay(*params.limits.avoided, c, keep, kCoarse * params.radius);
      if (avoided) here = std::max(here, keep - avoided->distance);
    }
    depth = std::min(depth, here);
  }
  return std::max(0.0, depth);
}

}  // namespace patchmill
