// Surfaces of Open CASCADE as ours.
#pragma once

#include <Geom_Surface.hxx>
#include <Standard_Handle.hxx>
#include <absl/status/statusor.h>

#include "core/base/vec.h"
#include "core/brep/brep_model.h"
#include "import/occt/parameter_map.h"

namespace patchmill {

// The surface without the rectangles that it is cut to; an offset of a plane, a cylinder, a cone, a sphere or
// a torus is again one of them. Parameters stay.
Handle(Geom_Surface) BareSurface(const Handle(Geom_Surface) & surface);

// Whether BrepSurface has a kind of its own for it.
bool IsElementary(const Geom_Surface& bare);

// The parameters that a face needs of its surface. An end counts as `exact` where the face ends along it.
struct NeededParameters {
  struct Range {
    double low = 0.0, high = 0.0;
    bool low_exact = false, high_exact = false;
  };
  Range u, v;
};

struct SurfacePart {
  BrepSurface surface;
  // From the parameters of the surface as given. Elementary surfaces have the same parameters.
  bool same_parameters = true;
  ParameterMap u, v;
  double error = 0.0;  // mm, by how much it differs at most from the surface as given; 0 where it is exact

  Vec2 Map(const Vec2& uv) const { return same_parameters ? uv : Vec2(u(uv.x()), v(uv.y())); }
};

// The part of the bare surface that covers the parameters, and a little more at ends that are not exact.
// Splines are cut, extrusions and surfaces of revolution become the rational splines that they are. Offsets
// of other surfaces, unknown kinds, and degrees above 15 are approximated within kApproximationError.
// INVALID_ARGUMENT, with the reason, for what has no such part: an offset that folds ("OFFSET_FOLDS ..."),
// weights that are not positive ("NEGATIVE_WEIGHT ..."). May throw Standard_Failure.
absl::StatusOr<SurfacePart> SurfaceOver(const Handle(Geom_Surface) & bare, const NeededParameters& needed);

}  // namespace patchmill
