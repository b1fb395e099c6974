// In which regions a pass lies.
#pragma once

#include <map>

#include "cam/region/map/region_map.h"
#include "cam/toolpath/cutter_path.h"

namespace patchmill {

// mm of the pass by the region below it, -1 where the map has none: moves along one piece by what they lead
// over, others half and half by the contacts of their ends. A point alone counts a little (1e-9), what rests
// on the floor nothing. The map may be empty.
std::map<int, double> LengthInRegions(const CutterPath& pass, const RegionMap& map);
// The same by components of regions.
std::map<int, double> LengthInComponents(const CutterPath& pass, const RegionMap& map);

}  // namespace patchmill
