// A surface point that slides over its piece towards the upward ray {c + s e_z, s >= 0} of a centre c. So it
// finds the point of one branch of the surface that is deepest in the ball or its upward sweep: the point
// nearest to the ray. Its distance from the ray is well conditioned for every slope ([location T1],
// [location, section 10]). The contact at the centre height h is not: on a steep wall it lies far up, and a
// small sideways move of the ball changes it much.
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

  // The side of the piece (numbered as in PieceSides) on which the point lies and that held back the last
  // step, or -1.
  int held_by() const { return held_by_; }

  const SurfacePoint& at() const { return at_; }

 private:
  const Surface* surface_;
  SurfacePoint at_;
  SurfaceJet jet_;
  int held_by_ = -1;
};

}  // namespace patchmill
