#include "cam/location/limits/shank_limit.h"

#include <algorithm>
#include <cmath>

#include "core/surface/highest.h"

namespace patchmill {

bool ShankLimit::Hits(const Vec2& a, const Vec2& b, double radius, double bottom) const {
  return AnyInColumn(*surface_, {a, b, radius}, bottom, proof_);
}

bool ShankLimit::Clears(const Vec3& a, const Vec3& b, double allowed_penetration) const {
  const double radius = radius_ - allowed_penetration, rise = rise_ + allowed_penetration;
  // If the shank stood at its lowest height all along, it would be at least as deep.
  if (!Hits(Xy(a), Xy(b), radius, std::min(a.z(), b.z()) + rise)) return true;
  if (std::abs(a.z() - b.z()) <= slope_) return false;
  const Vec3& low = a.z() < b.z() ? a : b;
  if (Hits(Xy(low), Xy(low), radius, low.z() + rise)) return false;
  const Vec3 middle = 0.5 * (a + b);
  return Clears(a, middle, allowed_penetration) && Clears(middle, b, allowed_penetration);
}

bool ShankLimit::Forbids(const Vec3& c, double beside, double above) const {
  return Hits(Xy(c), Xy(c), radius_ - beside, c.z() + above + rise_);
}

double ShankLimit::LowestOver(const Vec2& q, double allowed_penetration, double from, double gap) const {
  const auto highest = HighestInColumn(*surface_, {q, q, radius_ - allowed_penetration},
                                       from + rise_ + allowed_penetration, gap);
  return highest ? highest->p.z() - rise_ - allowed_penetration : -kInfinity;
}

}  // namespace patchmill
