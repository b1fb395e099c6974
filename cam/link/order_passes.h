// In which order, direction and from which start the passes are cut.
#pragma once

#include <cstddef>
#include <vector>

#include "cam/region/region_map.h"
#include "cam/toolpath/cutter_path.h"

namespace patchmill {

struct OrderParams {
  double neighbor_distance =
      3.0;  // mm in plan: passes of neighbouring lines closer than this belong together
  bool reversible_contours = false;
};

// Steep ground first, then gentle ground, then creases and rest; regions from the highest down. Within
// contours each mountain or basin is cut from the top before the next begins (levels never run ahead of a
// higher one that touches them in plan); zig-zag lines follow each other to and fro; everything else goes to
// the nearest end. Closed passes are turned so that they start nearest to where the tool is. Deterministic.
// Cost O(n^2) in the passes of one group.
std::vector<CutterPath> OrderPasses(const RegionMap& regions, std::vector<CutterPath> paths,
                                    const OrderParams& params);

// The same closed path started at its vertex `start`.
void RotateClosed(CutterPath& path, std::size_t start);
void Reverse(CutterPath& path);

}  // namespace patchmill
