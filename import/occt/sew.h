// Joining of faces that share no edges.
#pragma once

#include <TopoDS_Shape.hxx>

#include "import/occt/shape_labels.h"

namespace patchmill {

struct Sewing {
  double tolerance = 0.0;     // mm, of the step that was kept; 0: nothing was sewn
  int free_edges_before = 0;  // of the faces outside of solids
  int free_edges_after = 0;
};

// Sews shells and loose faces outside of solids where there are free edges: within 1e-5, 1e-4, 1e-3, 1e-2
// and 0.05 mm, at most 1e-4 of the diagonal, each on the faces as given, as long as the number of free
// edges falls. Faces that are narrower than four times the tolerance stay loose. A step that loses faces or
// changes their area by more than 1e-4 is not taken. Only topology changes. The new faces get the labels of
// those they are made from. Where nothing is gained, `shape` stays. May throw Standard_Failure.
Sewing SewLooseFaces(TopoDS_Shape& shape, ShapeLabels& labels);

}  // namespace patchmill
