// Area of a face, and its share of the volume of its body, from the file's surface and its curves on it.
#pragma once

#include <vector>

#include <Geom_Surface.hxx>
#include <Standard_Handle.hxx>

#include "import/occt/face_loops.h"

namespace patchmill {

struct FaceIntegrals {
  double area = 0.0;    // mm^2
  double volume = 0.0;  // mm^3: a third of the integral of the place times the normal S_u x S_v
};

// By Green's theorem: along the loops in v, gaps between neighbours closed by straight lines, and for each
// place from the lowest u to it. Gauss's rule between knots, halved, at most five times, until the halves
// agree to 1e-8 of the face. Open CASCADE's own figures (BRepGProp) are off by several percent on extrusions,
// and leave gaps open. Cost: as many evaluations for each step along the loops as the surface has knots in u.
// May throw Standard_Failure.
FaceIntegrals IntegrateFace(const Handle(Geom_Surface) & bare, const std::vector<SampledLoop>& loops);

}  // namespace patchmill
