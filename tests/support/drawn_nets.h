// Nets drawn by hand in three dimensions, curves only: faces, normals and creases are written here once.
// `folder`: tests/models/networks.
#pragma once

#include <string>
#include <vector>

#include "core/crossing/drawn_curve.h"
#include "core/joining/curve_network.h"

namespace patchmill::testing {

// `11-2-2`: a closed wedge of 9 faces, mirrored in x = 0. Its strokes are creases; the two halves meet
// smoothly. Unit: 1/100 of the drawing's.
CurveNetwork DrawnWedge(const std::string& folder);

// `computer-mouse`: the shell of a mouse, y up, 17 quads and 4 triangles, open below, smooth but for a crease
// of three edges along its left shoulder. The wheel and strokes drawn twice are left out; two strokes end on
// others: T-junctions. 29 x 10 x 43 mm.
CurveNetwork DrawnMouse(const std::string& folder);

// All strokes of such a file as curves, `scale` times as large, without what the file knows of nodes and
// segments.
std::vector<DrawnCurve> DrawnStrokes(const std::string& file, double scale);

}  // namespace patchmill::testing
