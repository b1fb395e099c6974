// Names a region map, so that overrides of single regions can say which map they were made for.
#pragma once

#include <string>

#include "cam/region/map/region_map.h"
#include "core/base/digest.h"

namespace patchmill {

// SHA-256 (32 bytes) over ids, kinds, slopes, reasons and borders.
std::string RegionsDigest(const RegionMap& map);

}  // namespace patchmill
