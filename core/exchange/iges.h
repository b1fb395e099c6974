// Writes B-spline surfaces as an IGES file.
#pragma once

#include <string>

#include "core/exchange/spline_surfaces.h"

namespace patchmill {

// Version 5.3, millimetres: one entity 128 (rational B-spline surface) per surface. Its label is the start of
// the name. Numbers read back as the same values. The same surfaces give the same bytes: the file has a fixed
// date. Cost O(bytes).
std::string IgesText(const SplineSurfaces& surfaces);

}  // namespace patchmill
