// The surface as shaded facets, the farthest first.
#pragma once

#include <array>
#include <vector>

#include "cam/picture/preview.h"
#include "cam/picture/view.h"

namespace patchmill {

struct Facet {
  std::array<Vec3, 4> corners;
  double nearness;
  int region;    // index into PreviewInput::regions, -1 none
  double shade;  // 0 dark .. 1 light
};

// How finely pieces are cut, along each side.
int FacetsPerSide(const Surface& surface);

// Facets across which the region changes are cut finer, so that colours keep to the borders.
std::vector<Facet> MakeFacets(const PreviewInput& input, const View& view);

}  // namespace patchmill
