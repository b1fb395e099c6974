#include "cam/location/shank_limit.h"

#include <algorithm>
#include <cmath>

#include "core/surface/highest.h"

namespace patchmill {

bool ShankLimit::Hits(const Vec2& a, const Vec2& b, double center_z, double give) const {
  return AnyInColumn(*surface_, {a, b, radius_ - give}, center_z + rise_ + give, proof_).has_value();
}

bool ShankLimit::Clears(const Vec3& a, const Vec3& b, double give) const {
  // As low as its lower end is all along, it is no less deep in.
  if (!Hits(Plan(a), Plan(b), std::min(a.z(), b.z()), give)) return true;
  if (std::abs(a.z() - b.z()) <= proof_) return false;
  const Vec3& low = a.z() < b.z() ? a : b;
  if (Hits(Plan(low), Plan(low), low.z(), give)) return false;
  const Vec3 middle = 0.5 * (a + b);
  return Clears(a, middle, give) && Clears(middle, b, give);
}

bool ShankLimit::Forbids(const Vec3& c, double radius) const { return Hits(Plan(c), Plan(c), c.z(), radius); }

double ShankLimit::LowestOver(const Vec2& q, double give, double from, double gap) const {
  const auto highest = HighestInColumn(*surface_, {q, q, radius_ - give}, from + rise_ + give, gap);
  return highest ? highest->p.z() - rise_ - give : -kInfinity;
}

}  // namespace patchmill
