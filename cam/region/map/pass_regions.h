// Measures in which regions a pass lies.
#pragma once

#include <map>

#include "cam/region/map/region_map.h"
#include "cam/toolpath/cutter_path.h"

namespace patchmill {

// Returns the length (mm) of the pass over each region. The key kNoRegion stands for places where the map has
// no region. A move with both contacts on one piece counts for the regions between them. Any other move
// counts half for the region at each of its ends. The first point counts 1e-9 mm, so that a pass of one point
// has a region, too. Points on the floor have no contact and count nothing. The map may be empty.
std::map<RegionId, double> LengthInRegions(const CutterPath& pass, const RegionMap& map);
// The same for components of regions.
std::map<ComponentId, double> LengthInComponents(const CutterPath& pass, const RegionMap& map);

}  // namespace patchmill
