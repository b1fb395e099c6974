// Area of a patch, and its share of the volume of a closed body.
#pragma once

#include <functional>

#include "core/patch/patch.h"

namespace patchmill {

struct PatchFigures {
  double area = 0.0;    // mm^2
  double volume = 0.0;  // mm^3: a third of the integral of (place - origin) . (S_u x S_v)
};

// The surface over [0,1]^2.
using JetFunction = std::function<SurfaceJet(double u, double v)>;

// By Gauss's rule on ever finer squares, until the area agrees to 1e-9 of it, at most on 16 x 16. Summed over
// the faces of a closed body whose patches have u x v outside, the volumes are that of the body, for any
// origin; one near the body keeps rounding small.
PatchFigures FiguresOf(const JetFunction& jet, const Vec3& origin);

}  // namespace patchmill
