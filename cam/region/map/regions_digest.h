// Which region map it is: what overrides of single regions are addressed by.
#pragma once

#include <string>

#include "cam/region/map/region_map.h"
#include "core/base/digest.h"

namespace patchmill {

// SHA-256 (32 bytes) over ids, kinds, slopes, reasons and borders.
std::string RegionsDigest(const RegionMap& map);

}  // namespace patchmill
