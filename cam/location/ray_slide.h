// A surface point that slides over its piece towards an upward ray. It finds the deepest point of one branch
// under a ball with everything above it.
//
// Where a wall is steep, h says little about how far the ball is in the way: its contact, the highest one,
// lies far up, and the disc of the contact ends at once. The point nearest to the upward ray
// {c + s e_z, s >= 0} is the deepest one. Its distance is well conditioned for every slope ([location T1],
// [location, section 10]).
#pragma once

#include "core/surface/surface.h"

namespace patchmill {

class RaySlide {
 public:
  // Keeps a reference to `surface`. `from` must lie on its piece (not checked).
  RaySlide(const Surface& surface, const SurfacePoint& from);

  // One safeguarded Newton step on its piece that shortens the distance to the upward ray from c. Returns the
  // length of the step, mm; 0 at a local minimum. Converges quadratically near a minimum where the ball fits
  // into the surface. c may change from step to step. Cost: one evaluation.
  double Step(const Vec3& c);

  // The side of the piece (numbered as in PieceSides) that held back the last step, or -1.
  int held_by() const { return held_by_; }

  const SurfacePoint& at() const { return at_; }

 private:
  const Surface* surface_;
  SurfacePoint at_;
  SurfaceJet jet_;
  int held_by_ = -1;
};

}  // namespace patchmill
