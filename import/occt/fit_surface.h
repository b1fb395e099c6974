// A polynomial spline near a surface that is none: a general offset, an unknown kind, one of too high a
// degree.
#pragma once

#include <Geom_Surface.hxx>
#include <Standard_Handle.hxx>
#include <absl/status/statusor.h>

#include "core/patch/patch.h"
#include "import/occt/surface_knots.h"

namespace patchmill {

struct FittedSurface {
  BsplinePatch patch;  // of the surface's own parameters; degree 5, continuous, smooth within the error
  double error = 0.0;  // mm: twice the largest distance that was found at the same parameters
};

// Interpolates at Chebyshev's places of each rectangle between knots. Rectangles are halved, along u or v
// all at once, until the surface and the spline agree between these places within half the tolerance (mm, >
// 0). Neighbours share their sides exactly. INVALID_ARGUMENT if 200 parts of a direction are not enough.
// Cost: some 70 evaluations for each rectangle. May throw Standard_Failure.
absl::StatusOr<FittedSurface> FitSurface(const Handle(Geom_Surface) & surface, const ParameterRange& u,
                                         const ParameterRange& v, double tolerance);

}  // namespace patchmill
