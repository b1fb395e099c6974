// The lines of a curve network as edges.
#pragma once

#include "core/base/diagnostic.h"
#include "core/joining/curve_network.h"

namespace patchmill {

// The network without lines; their edges come after the listed ones, line by line. Code: INVALID_LINE (a
// vertex that does not exist or lies on an edge, too few, neighbours that are one or coincide); such a line
// gives no edges.
CurveNetwork WithLinesAsEdges(const CurveNetwork& network, Diagnostics& findings);

}  // namespace patchmill
