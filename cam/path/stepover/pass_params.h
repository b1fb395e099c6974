// Parameters that every pass generator takes.
#pragma once

#include <algorithm>

#include "cam/toolpath/path_amount.h"
#include "core/base/vec.h"

namespace patchmill {

// The part of the surface that a generator covers, by the slope of the contact normal (centre - contact)/R
// from vertical.
struct SlopeWindow {
  double min = 0.0;        // rad
  double max = kPi / 2.0;  // rad, inclusive
};

struct PassParams {
  double scallop = 0.01;           // mm, (0, R)
  double chord_tolerance = 0.005;  // mm: gouge and excess of every chord, certificate gap included
  // mm: limit for the excess of chords of lines, contours and spirals, if it is below chord_tolerance.
  double excess_tolerance = kInfinity;
  double certificate_gap = 1e-4;  // mm: emitted heights are certified to this and raised by their gap
  double floor_z = -kInfinity;    // mm: the lowest TIP height; centres never go below floor_z + radius
  // Passes cover contacts in this window. They are extended beyond it by half a step along the pass.
  SlopeWindow window;
  // In flat step-overs: no passes lie closer together than this, whatever the scallop needs.
  double min_step_fraction = 0.25;
  // True: the ball rolls over every open edge, not only over rims that are locally highest ([machining M12]).
  bool roll = false;
  // A generator ends with the error of CheckAmount once its passes exceed this budget.
  PathBudget budget;
};

// What the chords of lines, contours and spirals may gouge and leave, as parts of the scallop [spacing,
// section 6]. With these limits the highest crest between two passes exceeds the requested scallop by at most
// 5 %. The chord tolerance alone is half of the whole tolerance, often as much as half of the scallop. Three
// things change the crest. Chords that gouge by d lower it by at most d / 2 where it is highest, however the
// vertices of the two passes lie to each other; the same holds for vertices below a concave surface
// (fewest_chords.h). What chords leave raises it by as much. Gaps that are wider than needed (kWideGap) raise
// it by up to 3.5 %.
inline constexpr double kGougeOfScallop = 0.1, kExcessOfScallop = 0.01;
// mm: for these limits a smaller scallop counts as this one. Finer chords would be below the positioning
// accuracy of machines, and programs would be many times as long.
inline constexpr double kFinestScallop = 0.005;

// Returns `params` with both chord tolerances reduced to these limits, where they exceed them.
inline PassParams WithFineChords(PassParams params) {
  const double scallop = std::max(params.scallop, kFinestScallop);
  params.chord_tolerance = std::min(params.chord_tolerance, kGougeOfScallop * scallop);
  params.excess_tolerance = std::min(params.excess_tolerance, kExcessOfScallop * scallop);
  return params;
}

// mm: what a chord may leave standing on the surface below it.
inline double ExcessTolerance(const PassParams& params) {
  return std::min(params.chord_tolerance, params.excess_tolerance);
}

}  // namespace patchmill
