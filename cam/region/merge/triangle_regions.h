// The regions and components of a split surface, triangle by triangle.
#pragma once

#include <cstddef>
#include <vector>

#include "cam/region/split/split_mesh.h"
#include "core/base/typed_id.h"

namespace patchmill {

// Every triangle belongs to a region and to a component of it. Every region has at least one component.
struct TriangleRegions {
  std::size_t region_count = 0;
  PerTriangle<RegionId> region_of;
  PerTriangle<ComponentId> component_of;
  std::vector<RegionId> component_region;  // [component]: its region, rising
};

}  // namespace patchmill
