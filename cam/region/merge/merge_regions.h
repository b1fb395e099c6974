// Raw regions of the split -> regions a machinist would draw ([regions, section 5]). Grouping and order
// only, never coverage.
#pragma once

#include <vector>

#include "cam/region/map/region_map.h"
#include "cam/region/split/split_mesh.h"

namespace patchmill {

struct RawRegion {
  SplitLabel label;
  double area = 0.0;         // mm^2
  double curvature = 0.0;    // integral of kappa_c, mm: how much of a mountain or basin it is
  double steepness = 0.0;    // integral of slope - steep angle, rad mm^2: how much it is steep or gentle
  int whole = -1;            // parts of one connected label name one of them; -1: it is whole
  int summit = 0, pit = 0;   // which mountain and which basin it belongs to, if it is a part of either
  double open_border = 0.0;  // mm of its border where the surface ends
};

struct RawContact {
  int a = 0, b = 0;     // raw regions
  double length = 0.0;  // mm of common border
};

struct MergeParams {
  double border_turn = 0.1;    // rad: what a mm of border costs against a mm^2 of contour curvature
  double border_slope = 0.3;   // rad mm: and against a mm^2 of slope off the steep angle
  double flat = 0.0022;        // 1/mm: mean contour curvature that no tool could feel
  double flat_cost = 0.017;    // 1/mm: what a mm^2 of flat ground costs that goes with a mountain or basin
  double min_area = 50.0;      // mm^2: smaller reachable regions join a neighbour
  double min_width = 3.0;      // mm: narrower ones too; of a strip, 2 areas over the length of all its border
  double min_curvature = 0.5;  // mm: regions that bend less than this in all are neutral
  double sliver = 0.01;        // mm: what is out of reach and narrower goes with a neighbour out of reach
  int max_regions = 20;        // reachable ones; smaller ones join others as steep while there are more
};

struct MergedRegions {
  std::vector<int> group;         // of each raw region, 0..count-1
  std::vector<SplitLabel> label;  // of each group
};

// First every whole gets the labels that cost least in all: what it gives up in curvature and slope
// against the length of the borders drawn (a Potts energy; mountain - neutral - basin as three ordered labels
// falls into two cuts, steep - gentle is a third, each least by MinCut). There is no order of merging: the
// labels follow from the areas and lengths of the split alone, and a strip whose normal turns by less than
// 2 border_turn, or whose slope is off by less than 2 border_slope over its width, goes with its sides. Then
// neighbours of equal labels are one region, mountains of different summits and basins of different pits
// apart, and the smallest (by area, then index) of those below min_area or min_width joins the neighbour with
// the longest common border. What is left
// below min_area has no neighbour: all of one label goes with the largest region of that label, or is one by
// itself from a tenth of min_area on, and less goes with the largest of its slope. Then the smallest of all
// while there are more than max_regions, but never steep ground with gentle: with a neighbour, or with those
// of its label that are as large, so that many equal features are one region. There may be more than
// max_regions in the end where labels differ. What no ball reaches keeps
// apart from what is reached; it fuses by reason, but for slivers.
MergedRegions MergeRegions(const std::vector<RawRegion>& raw, const std::vector<RawContact>& contacts,
                           const MergeParams& params);

}  // namespace patchmill
