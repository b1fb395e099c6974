// The surface as coloured facets, the farthest first.
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
  int region;         // index into PreviewInput::regions, -1 none
  std::string color;  // CSS
};

// How finely pieces are cut, along each side.
int FacetsPerSide(const Surface& surface);

// Painted by region, facets across which the region changes are cut finer, so that colours keep to the
// borders; by slope or curvature, all are finer.
std::vector<Facet> MakeFacets(const PreviewInput& input, const View& view, Paint paint);

}  // namespace patchmill
