#include "cam/verify/reach.h"

#include <algorithm>
#include <array>

#include "core/diffgeo/forms.h"
#include "core/surface/closest.h"

namespace patchmill {

namespace {

constexpr double kVertical = 1e-6;    // e_z below this: a vertical face
constexpr double kProof = 0.02;       // of the tolerance: how exactly "free" is decided
constexpr double kCoarse = 0.02;      // of the radius: how exactly the blocking point is known
constexpr double kFloorSlack = 1e-6;  // mm: rounding of a floor at the surface itself

std::array<Vec3, 2> Centers(const Vec3& p, const Facing& facing, double radius) {
  return {p + radius * facing.e, p - radius * facing.e};
}

// The shank is blocked, and the ball is not, or less. Beside a wall both are blocked alike: by the ball.
bool BlockedAbove(const Surface& surface, const Vec3& c, double limit, double tolerance) {
  const auto nearest = ClosestToUpwardRay(surface, c, limit, tolerance);
  return nearest && nearest->at.p.z() > c.z() &&
         !ClosestToPoint(surface, c, std::min(limit, nearest->distance + 2.0 * tolerance), tolerance);
}

}  // namespace

std::optional<Facing> FacingAt(const SurfaceJet& jet) {
  const std::optional<Vec3> normal = UpwardNormal(jet);
  if (!normal) return std::nullopt;
  return Facing{*normal, normal->z() < kVertical};
}

ReachClass ReachAt(const Surface& surface, const Vec3& p, const Facing& facing, const ReachParams& params) {
  const double limit = params.radius - params.tolerance;
  const auto centers = Centers(p, facing, params.radius);
  ReachClass reason = ReachClass::kReachable;
  for (int side = 0; side < (facing.both ? 2 : 1); ++side) {
    const Vec3& c = centers[static_cast<std::size_t>(side)];
    ReachClass found = ReachClass::kReachable;
    if (AnythingNearUpwardRay(surface, c, limit, kProof * params.tolerance)) {
      found = BlockedAbove(surface, c, limit, kCoarse * params.radius) ? ReachClass::kUndercut
                                                                       : ReachClass::kConcave;
    } else if (c.z() < params.floor_z - kFloorSlack) {
      found = ReachClass::kFloor;
    }
    if (found == ReachClass::kReachable) return found;
    // Of two blocked sides the one that is easier to free gives the reason: floor, ball, then undercut.
    if (side == 0 || found > reason) reason = found;
  }
  return reason;
}

double BlockedDepth(const Surface& surface, const Vec3& p, const Facing& facing, const ReachParams& params) {
  const double limit = params.radius - params.tolerance;
  const auto centers = Centers(p, facing, params.radius);
  double depth = kInfinity;
  for (int side = 0; side < (facing.both ? 2 : 1); ++side) {
    const Vec3& c = centers[static_cast<std::size_t>(side)];
    double here = params.floor_z - kFloorSlack - c.z();
    const auto nearest = ClosestToUpwardRay(surface, c, limit, kCoarse * params.radius);
    if (nearest) here = std::max(here, limit - nearest->distance);
    depth = std::min(depth, here);
  }
  return std::max(0.0, depth);
}

}  // namespace patchmill
