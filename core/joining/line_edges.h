// Turns the lines of a curve network into edges.
#pragma once

#include "core/base/diagnostic.h"
#include "core/joining/curve_network.h"

namespace patchmill {

// The network without lines. Their edges come after the listed ones, line by line. Code: INVALID_LINE (a
// vertex that does not exist or lies on an edge, too few vertices, neighbours that are the same vertex or
// coincide, ends that no spline meets). Such a line gives no edges.
CurveNetwork WithLinesAsEdges(const CurveNetwork& network, Diagnostics& findings);

}  // namespace patchmill
