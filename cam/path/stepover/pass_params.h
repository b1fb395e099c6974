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
  double scallop = 0.01;                // mm, (0, R)
  double chord_tolerance = 0.005;       // mm: gouge and excess of every chord, certificate gap included
  double excess_tolerance = kInfinity;  // mm: excess of chords of lines, contours and spirals, if below
                                        // chord_tolerance
  double certificate_gap = 1e-4;        // mm: emitted heights are certified to this and raised by their gap
  double floor_z = -kInfinity;          // mm: the lowest TIP height; centres never go below floor_z + radius
  SlopeWindow window;               // passes cover contacts in this window, dilated by half a step along the
                                    // pass
  double min_step_fraction = 0.25;  // a required step below this part of the flat step-over counts as this
                                    // part
  // True: the ball rolls over every open edge, not only over rims that are locally highest ([machining M12]).
  bool roll = false;
  // A generator ends with the error of CheckAmount once its passes exceed this budget.
  PathBudget budget;
};

// What the chords of lines, contours and spirals may gouge and leave, as parts of the scallop. With these
// limits the finish is within 5 % of the requested one at the worst spot between two passes. The tolerance
// alone would allow half of itself, often half the scallop. Chords that gouge by g lower the crest between
// two passes by at most g / 2 where it is highest, however the vertices of the passes lie to each other. What
// chords leave adds to the scallop, and so do the 3.5 % that kWideGap admits. On a concave surface vertices
// go into the surface by half of what chords may gouge (fewest_chords.h). This is the same to the crest.
inline constexpr double kGougeOfScallop = 0.1, kExcessOfScallop = 0.01;
// mm: a smaller scallop counts as this one here. Chords for less would be finer than machines place their
// tools, and programs many times as long.
inline constexpr double kFinestScallop = 0.005;

// Returns `params` with chords as fine as these limits ask, where its own are not.
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
