// Where a shank that is wider than the ball is clear of a surface: a limit of the ball's centre.
#pragma once

#include <optional>

#include "cam/limits/wide_shank.h"
#include "core/surface/surface.h"

namespace patchmill {

// The shank over a centre c is as deep in the surface as the deepest point p with distance d from the axis in
// plan is in its cylinder: min(radius - d, p_z - c_z - rise). Moving c by some mm changes that by no more.
class ShankLimit {
 public:
  // Keeps `keep` (mm) off `surface`, which must stay: a cylinder that much wider, that begins so much lower.
  // Answers are right to `proof` (mm), of moves that climb or fall to `slope` (mm).
  ShankLimit(const Surface& surface, const WideShank& shank, double keep, double proof, double slope)
      : surface_(&surface),
        radius_(shank.radius + keep),
        rise_(shank.rise - keep),
        proof_(proof),
        slope_(slope) {}

  // The highest point of `surface` may be in it while the centre is no lower than this.
  bool MayTouch(double lowest_center) const { return surface_->box.max.z() > lowest_center + rise_; }
  // Along the whole straight move of the centre the shank is nowhere deeper in than `give` (mm). Cost: some
  // microseconds; a move along the limit as often as it changes height by `slope`, and a column as wide as a
  // bore milliseconds.
  bool Clears(const Vec3& a, const Vec3& b, double allowed_penetration) const;
  // Wherever the centre is within `beside` of c in plan and at most `above` higher (mm, >= 0), the surface is
  // in it.
  bool Forbids(const Vec3& c, double beside, double above) const;
  // Lowest centre over q where the shank is no deeper in than `give`, if that is above `from` (mm);
  // -infinity otherwise. To `gap` (mm).
  double LowestOver(const Vec2& q, double allowed_penetration, double from, double gap) const;

 private:
  bool Hits(const Vec2& a, const Vec2& b, double radius, double bottom) const;

  const Surface* surface_;
  double radius_, rise_, proof_, slope_;
};

}  // namespace patchmill
