// The limit that a cylinder above the ball, a wide shank or a part of the holder, sets to the centre: the
// cylinder must stay clear of a surface.
#pragma once

#include "cam/limits/upper_cylinders.h"
#include "core/surface/surface.h"

namespace patchmill {

// With the centre at c, a surface point p at the distance d from the axis in plan lies in the cylinder by
// min(radius - d, p_z - c_z - rise) [regions (9)]. The depth of the cylinder in the surface is the largest
// such value. It changes by no more than c moves.
class ShankLimit {
 public:
  // The cylinder keeps the distance `keep` (mm) from `surface`, which must outlive this object: the
  // cylinder is widened by `keep` and begins lower by `keep`. Answers are exact to `proof` (mm). For a move
  // that climbs or falls they are exact to `slope` (mm), since such a move is divided into steps of this
  // height.
  ShankLimit(const Surface& surface, const UpperCylinder& cylinder, double keep, double proof, double slope)
      : surface_(&surface),
        radius_(cylinder.radius + keep),
        rise_(cylinder.rise - keep),
        proof_(proof),
        slope_(slope),
        part_(cylinder.part) {}

  UpperPart part() const { return part_; }

  // True if the highest point of `surface` may be in the shank of some centre that is no lower than
  // `lowest_center` (mm).
  bool MayTouch(double lowest_center) const { return surface_->box.max.z() > lowest_center + rise_; }
  // True if the depth of the shank stays at most `allowed_penetration` (mm) all along the straight move of
  // the centre from a to b. Cost: some microseconds, for a move close to the limit once for every `slope` mm
  // of its change in height. In a bore as wide as the shank it costs milliseconds.
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
  UpperPart part_;
};

}  // namespace patchmill
