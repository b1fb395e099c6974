// What every pass generator needs.
#pragma once

#include "core/base/vec.h"

namespace patchmill {

// Which part of the surface a generator covers, by the slope of the contact normal (centre - contact)/R from
// vertical.
struct SlopeWindow {
  double min = 0.0;        // rad
  double max = kPi / 2.0;  // rad, inclusive
};

struct PassParams {
  double scallop = 0.01;            // mm, (0, R)
  double chord_tolerance = 0.005;   // mm: gouge and excess of every chord, certificate gap included
  double certificate_gap = 1e-4;    // mm: emitted heights are certified to this and raised by their gap
  double floor_z = -kInfinity;      // mm: the lowest TIP height; centres never go below floor_z + radius
  SlopeWindow window;               // passes cover contacts in here, dilated by half a step along the pass
  double min_step_fraction = 0.25;  // needs below this part of the flat step-over count as this part
  // The ball rolls over every open border, not only over rims that are locally highest (MACHINING A.12).
  bool roll = false;
};

}  // namespace patchmill
