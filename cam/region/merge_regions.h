// Raw regions of the split -> regions a machinist would draw (ALGORITHMS 4, merging). Grouping and order
// only, never coverage.
#pragma once

#include <vector>

#include "cam/region/region_map.h"
#include "cam/region/split_mesh.h"

namespace patchmill {

struct RawRegion {
  SplitLabel label;
  double area = 0.0;       // mm^2
  double curvature = 0.0;  // integral of kappa_c, mm: how much of a mountain or basin it is
};

struct RawContact {
  int a = 0, b = 0;     // raw regions
  double length = 0.0;  // mm of common border
};

struct MergeParams {
  double min_area = 50.0;      // mm^2: smaller reachable regions join a neighbour
  double min_curvature = 0.5;  // mm: regions that bend less than this in all are neutral
};

struct MergedRegions {
  std::vector<int> group;         // of each raw region, 0..count-1
  std::vector<SplitLabel> label;  // of each group
};

// Deterministic function of its input: neutral relabelling, fusing of equal labels, then again and again the
// smallest region (by area, then index) below min_area joins the neighbour with the longest common border
// (ties: lower index), equal labels fuse. Regions that no ball reaches keep apart from those that are
// reached; they fuse by reason.
MergedRegions MergeRegions(const std::vector<RawRegion>& raw, const std::vector<RawContact>& contacts,
                           const MergeParams& params);

}  // namespace patchmill
