// What every pass generator needs.
#pragma once

#include <algorithm>

#include "cam/toolpath/path_amount.h"
#include "core/base/vec.h"

namespace patchmill {

// Which part of the surface a generator covers, by the slope of the contact normal (centre - contact)/R from
// vertical.
struct SlopeWindow {
  double min = 0.0;        // rad
  double max = kPi / 2.0;  // rad, inclusive
};

struct PassParams {
  double scallop = 0.01;           // mm, (0, R)
  double chord_tolerance = 0.005;  // mm: gouge and excess of every chord, certificate gap included
  double excess_tolerance =
      kInfinity;                    // mm: excess of chords of lines, contours and spirals, where that is less
  double certificate_gap = 1e-4;    // mm: emitted heights are certified to this and raised by their gap
  double floor_z = -kInfinity;      // mm: the lowest TIP height; centres never go below floor_z + radius
  SlopeWindow window;               // passes cover contacts in here, dilated by half a step along the pass
  double min_step_fraction = 0.25;  // needs below this part of the flat step-over count as this part
  // The ball rolls over every open border, not only over rims that are locally highest ([machining M12]).
  bool roll = false;
  // Generators end with CheckAmount's error once what they make passes it.
  PathBudget budget;
};

// What the chords of lines, contours and spirals may take away and leave, as parts of the scallop, so that
// the finish is the one asked for within 5 % at the worst spot between two passes; the tolerance alone would
// allow half of itself, often half the scallop. Chords that gouge by g lower the crest between two passes by
// g / 2 at most where it is highest, however their vertices lie to each other; what they leave comes on top
// of the scallop, and so do the 3.5 % that kWideGap lets through. Vertices on hollow ground go into it by
// half of what chords may take (fewest_chords.h), which is the same to the crest.
inline constexpr double kGougeOfScallop = 0.1, kExcessOfScallop = 0.01;
// mm: what scallops are taken for at least here: under a smaller one the chords would be finer than machines
// place their tools, and programs many times as long.
inline constexpr double kFinestScallop = 0.005;

// The same with chords that fine, where its own are not.
inline PassParams WithFineChords(PassParams params) {
  const double scallop = std::max(params.scallop, kFinestScallop);
  params.chord_tolerance = std::min(params.chord_tolerance, kGougeOfScallop * scallop);
  params.excess_tolerance = std::min(params.excess_tolerance, kExcessOfScallop * scallop);
  return params;
}

// What chords may leave standing on the ground below them, mm.
inline double ExcessTolerance(const PassParams& params) {
  return std::min(params.chord_tolerance, params.excess_tolerance);
}

}  // namespace patchmill
