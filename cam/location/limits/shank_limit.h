// Where a shank that is wider than the ball is clear of a surface. This is a limit of the ball's centre.
#pragma once

#include <optional>

#include "cam/limits/wide_shank.h"
#include "core/surface/surface.h"

namespace patchmill {

// The depth of the shank over a centre c in the surface is that of the deepest point p. A point at the
// distance d from the axis in plan has the depth min(radius - d, p_z - c_z - rise). If c moves by some mm,
// the depth changes by no more.
class ShankLimit {
 public:
  // Keeps `keep` (mm) off `surface`, which must outlive this object: the cylinder is that much wider and
  // begins that much lower. Answers are exact to `proof` (mm), for moves that climb or fall to `slope` (mm).
  ShankLimit(const Surface& surface, const WideShank& shank, double keep, double proof, double slope)
      : surface_(&surface),
        radius_(shank.radius + keep),
        rise_(shank.rise - keep),
        proof_(proof),
        slope_(slope) {}

  // Whether the highest point of `surface` may be in the shank while the centre is no lower than this.
  bool MayTouch(double lowest_center) const { return surface_->box.max.z() > lowest_center + rise_; }
  // True if the shank is nowhere deeper than `allowed_penetration` (mm) along the whole straight move of the
  // centre. Cost: some microseconds. A move along the limit costs this once for every `slope` of its change
  // of height. A column as wide as a bore costs milliseconds.
  bool Clears(const Vec3& a, const Vec3& b, double allowed_penetration) const;
  // True if the surface is in the shank wherever the centre is within `beside` of c in plan and at most
  // `above` higher (mm, >= 0).
  bool Forbids(const Vec3& c, double beside, double above) const;
  // The lowest centre over q at which the shank is no deeper than `allowed_penetration`, if that is above
  // `from` (mm); otherwise -infinity. Exact to `gap` (mm).
  double LowestOver(const Vec2& q, double allowed_penetration, double from, double gap) const;

 private:
  bool Hits(const Vec2& a, const Vec2& b, double radius, double bottom) const;

  const Surface* surface_;
  double radius_, rise_, proof_, slope_;
};

}  // namespace patchmill
