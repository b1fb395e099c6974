// Which regions have circular lines: rims, shoulders, any gentle area around an axis.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/plan/job_context.h"
#include "cam/plan/region_choices.h"

namespace patchmill {

struct CircularChoices {
  RegionChoices regions;              // with the circles that pay; nothing is open about circles any more
  std::vector<CircularTrial> trials;  // by id
};

// Gives circles (RegionChoice::around) to the components of regions that are open about them, where circles
// pay.
//
// Candidates are reachable regions with the strategy AUTO whose lines run both ways. Each component of a
// region is a candidate by itself, so that each of many rims has circles of its own; there are at most 5
// million divided by the number of pieces. Only the selected gentle area of a component counts: all of a
// gentle region, and in a steep region the gentle area that merging left in it.
//
// The common centre c of the circles minimises the weighted sum of squares of m . (p - c). One set of terms
// has points p spread over the area, with m the horizontal direction square to the normal, as long as the
// sine of the slope. The other has points on the borders of the gentle area, with m the direction of the
// border, weighted by length times one flat step-over. Terms that miss c by more than a ball radius count
// less.
//
// Circles pay where their length, with the links to each run, is a tenth shorter than that of straight lines
// at their angle. Both lengths are estimates: from the steps needed at the points of MeasureRegions (one in
// four of them) and from the number of lines that end at borders and at the split angle. The area has to
// surround c for three quarters of a turn at least, and to keep a ball radius and a step away from it. In a
// steep region the borders of the gentle area also have to run along the circles, within an angle of 0.2 rad
// on average.
//
// Where the angle is open, circles are compared with the best of six angles. Circles a fifth shorter are
// taken at once; where all lines of a region are such circles its angle is no longer open. Circles that are
// less than a fifth longer become trials of their region (QuickestAngles), because the estimate may be wrong
// by that. CANCELLED, DEADLINE_EXCEEDED from the run.
absl::StatusOr<CircularChoices> ChooseCircularLines(const JobContext& context, const RegionMap& map,
                                                    RegionChoices chosen);

}  // namespace patchmill
