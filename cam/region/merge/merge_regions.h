// Merges the raw regions of the split into regions as a machinist would draw them [regions, section 5]. This
// decides how passes are grouped and ordered, never what is cut.
#pragma once

#include <vector>

#include "cam/region/map/region_map.h"
#include "cam/region/split/split_mesh.h"

namespace patchmill {

struct RawRegion {
  SplitLabel label;
  double area = 0.0;       // mm^2
  double curvature = 0.0;  // mm, integral of kappa_c: < 0 for a mountain, > 0 for a basin
  double steepness = 0.0;  // rad mm^2, integral of slope - steep angle: > 0 for steep
  int whole =
      -1;  // first raw region of the connected area with the same label to which it belongs; -1: itself
  int summit = 0, pit = 0;   // the mountain and the basin that it belongs to, if any
  double open_border = 0.0;  // mm of its border where the surface ends
};

struct RawContact {
  int a = 0, b = 0;     // the two raw regions
  double length = 0.0;  // mm of common border
};

struct MergeParams {
  double border_turn = 0.1;    // rad; cost of a mm of border between curvature labels, in mm of `curvature`
  double border_slope = 0.3;   // rad mm; cost of a mm of border between steep and gentle, in `steepness`
  double flat = 0.0022;        // 1/mm; an area with a smaller mean contour curvature counts as flat
  double flat_cost = 0.017;    // 1/mm; cost of a mm^2 of flat area with the label of a mountain or basin
  double min_area = 50.0;      // mm^2; smaller reachable regions join a neighbour
  double min_width = 3.0;      // mm; narrower ones, too. Width is 2 area / length of the whole border
  double min_curvature = 0.5;  // mm; a region is neutral if the integral of kappa_c is smaller
  double sliver = 0.01;        // mm; narrower unreachable regions join an unreachable neighbour
  int max_regions = 20;        // reachable regions; while there are more, the smallest join others
};

struct MergedRegions {
  std::vector<int> group;         // [raw region]: its group, 0..count-1
  std::vector<SplitLabel> label;  // [group]
};

// 1. Every whole gets new labels [regions (4), (5)]. They minimise what wholes lose in curvature and slope
//    plus the cost of the borders that remain (a Potts energy). Mountain, neutral and basin are three ordered
//    labels, which fall into two minimum cuts; steep against gentle is a third (MinCut). The result does not
//    depend on an order of merging, only on the areas and lengths of the split. A strip joins its sides if
//    its normal turns by less than 2 border_turn across it, or if its slope times its width is off by less
//    than 2 border_slope.
// 2. Neighbours of equal labels become one region, except mountains of different summits and basins of
//    different pits.
// 3. Unreachable slivers join an unreachable neighbour. Regions with little curvature become neutral.
// 4. The smallest region (by area, then by index) below min_area or min_width joins the neighbour with the
//    longest common border, again and again.
// 5. Regions still below min_area have no neighbour. Those of one label join the largest region of that
//    label. If there is none they form a region if it has a tenth of min_area and there are not too many
//    regions; else they join the largest region of their slope class.
// 6. While there are more than max_regions, the smallest joins a neighbour of its slope class. If it has
//    none, all regions of its label that are hardly larger become one with the largest of that label, so
//    that many equal features form one region. Steep never joins gentle here, so more than max_regions may
//    remain.
// 7. Unreachable regions below min_area become one region for each reason.
//
// Unreachable regions never join reachable ones. Their reasons mix only where slivers are absorbed.
MergedRegions MergeRegions(const std::vector<RawRegion>& raw, const std::vector<RawContact>& contacts,
                           const MergeParams& params);

}  // namespace patchmill
