#include "cam/region/reach.h"

#include <algorithm>
#include <cmath>

#include "core/diffgeo/forms.h"
#include "core/surface/closest.h"

namespace patchmill {

namespace {

constexpr double kVertical = 1e-9;  // |e_z| below this: no side is the upper one

}  // namespace

// The floor is where the model ends: rounding must not make its lowest point unreachable.
bool ReachTest::AboveFloor(const Vec3& center) const {
  return center.z() - params_.radius >= params_.floor_z - params_.tolerance;
}

UnreachableReason ReachTest::At(const Vec3& p, const Vec3& normal, std::optional<SurfacePoint>* last) const {
  const Vec3 c = p + params_.radius * normal;
  if (!free_ball_.Free(c)) {
    const auto blocking = free_ball_.Height(Plan(c), last != nullptr && *last ? &**last : nullptr);
    if (last != nullptr && blocking) *last = blocking->contact;
    const bool above = blocking && blocking->contact.p.z() > c.z();
    return above ? UnreachableReason::kUndercut : UnreachableReason::kConcave;
  }
  return AboveFloor(c) ? UnreachableReason::kNone : UnreachableReason::kFloor;
}

UnreachableReason ReachTest::Reason(const Piece& piece, double u, double v,
                                    std::optional<SurfacePoint>* last) const {
  const SurfaceJet jet = Evaluate(piece, u, v);
  const auto normal = UpwardNormal(jet);
  if (!normal) return UnreachableReason::kNone;
  const UnreachableReason reason = At(jet.p, *normal, last);
  if (reason != UnreachableReason::kNone && std::abs(normal->z()) < kVertical) {
    return At(jet.p, -*normal, last);
  }
  return reason;
}

bool ReachTest::Reachable(const Piece& piece, double u, double v) const {
  const SurfaceJet jet = Evaluate(piece, u, v);
  const auto normal = UpwardNormal(jet);
  if (!normal) return true;
  const auto stands = [&](const Vec3& c) { return AboveFloor(c) && free_ball_.Free(c); };
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
        r <= tolerance || !ClosestToUpwardRay(surface, p + r * normal, r - tolerance, 0.1 * tolerance);
    (free ? low : high) = r;
  }
  return low;
}

}  // namespace patchmill
