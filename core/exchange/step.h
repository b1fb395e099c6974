// Writes B-spline surfaces as a STEP file.
#pragma once

#include <string>

#include "core/exchange/spline_surfaces.h"

namespace patchmill {

// ISO 10303-21 with the schema AUTOMOTIVE_DESIGN (AP214), millimetres: an open shell with one face per
// surface, bounded by the surface's own sides. A side that is one point has no edge. Numbers read back as the
// same values. The same surfaces give the same bytes: the file has a fixed date. Cost O(bytes).
std::string StepText(const SplineSurfaces& surfaces);

}  // namespace patchmill
