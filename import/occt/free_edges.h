// Edges at which only one face of a shape ends.
#pragma once

#include <TopoDS_Shape.hxx>

namespace patchmill {

// Edges with one use by all faces of the shape. Seams have two, poles do not count.
int CountFreeEdges(const TopoDS_Shape& shape);

}  // namespace patchmill
