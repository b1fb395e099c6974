#include "cam/region/reach.h"

#include <algorithm>
#include <cmath>

#include "core/diffgeo/forms.h"
#include "core/surface/closest.h"

namespace patchmill {

namespace {

// The constants of docs/reach.md.
constexpr double kVertical = 1e-6;    // |e_z| below this: no side is the upper one
constexpr double kNearer = 0.02;      // of the radius: what blocks above is nearer by this
constexpr double kFloorSlack = 1e-6;  // mm

constexpr double kProof = 0.004;  // of the radius: how exactly distances are known here

}  // namespace

bool ReachTest::AboveFloor(const Vec3& center) const {
  return center.z() - params_.radius >= params_.floor_z - kFloorSlack;
}

bool ReachTest::Allowed(const Vec3& center) const {
  return params_.keep_in == nullptr || params_.keep_in->Allows(center);
}

UnreachableReason ReachTest::At(const Vec3& center) const {
  if (free_ball_.Free(center)) {
    if (!AboveFloor(center)) return UnreachableReason::kFloor;
    return Allowed(center) ? UnreachableReason::kNone : UnreachableReason::kAvoided;
  }
  const Surface& surface = free_ball_.surface();
  const double proof = kProof * params_.radius;
  const auto shank = ClosestToUpwardRay(surface, center, free_ball_.radius() + proof, proof);
  if (!shank || shank->at.p.z() <= center.z()) return UnreachableReason::kConcave;
  const bool ball =
      ClosestToPoint(surface, center, shank->distance + kNearer * params_.radius, proof).has_value();
  return ball ? UnreachableReason::kConcave : UnreachableReason::kUndercut;
}

UnreachableReason ReachTest::Reason(const Piece& piece, double u, double v) const {
  const SurfaceJet jet = Evaluate(piece, u, v);
  const auto normal = UpwardNormal(jet);
  if (!normal) return UnreachableReason::kNone;
  const UnreachableReason reason = At(jet.p + params_.radius * *normal);
  if (reason == UnreachableReason::kNone || std::abs(normal->z()) >= kVertical) return reason;
  const UnreachableReason other = At(jet.p - params_.radius * *normal);
  return other == UnreachableReason::kNone ? other : std::max(reason, other);
}

bool ReachTest::Reachable(const Piece& piece, double u, double v) const {
  const SurfaceJet jet = Evaluate(piece, u, v);
  const auto normal = UpwardNormal(jet);
  if (!normal) return true;
  const auto stands = [&](const Vec3& c) { return AboveFloor(c) && free_ball_.Free(c) && Allowed(c); };
  return stands(jet.p + params_.radius * *normal) ||
         (std::abs(normal->z()) < kVertical && stands(jet.p - params_.radius * *normal));
}

double ReachTest::LeftoverAbove(const Vec3& p) const {
  const auto above = free_ball_.Height(Plan(p));
  if (!above) return 0.0;
  const double center = std::max(above->z, params_.floor_z + params_.radius);
  return std::max(0.0, center - p.z() - params_.radius);
}

double LargestFreeRadius(const Surface& surface, const Vec3& p, const Vec3& normal, double limit,
                         double tolerance) {
  double low = 0.0, high = limit;
  for (int i = 0; i < 12; ++i) {
    const double r = 0.5 * (low + high);
    const bool free =
        r <= tolerance || !AnythingNearUpwardRay(surface, p + r * normal, r - tolerance, 0.1 * tolerance);
    (free ? low : high) = r;
  }
  return low;
}

}  // namespace patchmill
