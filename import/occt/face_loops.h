// The loops of a face in the parameters of its surface, as Open CASCADE has them.
#pragma once

#include <vector>

#include <Geom_Surface.hxx>
#include <Standard_Handle.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <absl/status/statusor.h>

#include "core/base/vec.h"
#include "import/occt/edge_table.h"
#include "import/occt/place_curve.h"
#include "import/occt/surfaces.h"

namespace patchmill {

// One side of an edge: places from the begin of the edge's curve to its end.
struct SampledUse {
  int edge = 0;  // number in the EdgeTable
  bool forward = true, seam = false, degenerate = false;
  std::vector<double> at;   // parameters of Open CASCADE on the edge's curve; increasing
  std::vector<Vec2> place;  // parameters of the surface
  PlaceCurve curve;         // on which they lie

  const Vec2& begin() const { return forward ? place.front() : place.back(); }  // along the loop
  const Vec2& end() const { return forward ? place.back() : place.front(); }
};
using SampledLoop = std::vector<SampledUse>;

// The loops of the face taken as FORWARD: the face lies to the left of them. The outer one comes first. Each
// edge is sampled at 17 places a span, but at most at 400 in all, or at its knots if there are more. `bare`
// is the face's surface (BareSurface). On periodic and closed surfaces neighbours in a loop are shifted so
// that they meet, and loops so that they lie beside the outer one. Errors name the edge that cannot be used.
// May throw Standard_Failure.
absl::StatusOr<std::vector<SampledLoop>> SampleLoops(const TopoDS_Face& face,
                                                     const Handle(Geom_Surface) & bare, EdgeTable& edges);

// The parameters of all places of the loops.
NeededParameters ParametersOf(const std::vector<SampledLoop>& loops);

}  // namespace patchmill
