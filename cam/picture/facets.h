// Divides the surface into coloured facets, the farthest first.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "cam/picture/preview.h"
#include "cam/picture/view.h"

namespace patchmill {

struct Facet {
  std::array<Vec3, 4> corners;
  double nearness;
  int region;         // index into PreviewInput::regions, or -1
  std::string color;  // CSS
};

// The number of facets along each side of a piece, before any are divided.
int FacetsPerSide(const Surface& surface);

// If painted by region, facets that a border crosses are divided, so that colours follow the borders. If
// painted by slope or curvature, pieces may have more facets from the start.
std::vector<Facet> MakeFacets(const PreviewInput& input, const View& view, Paint paint);

}  // namespace patchmill
