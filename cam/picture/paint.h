// Chooses the colour of a point of the surface in a view.
#pragma once

#include <string>

#include "core/diffgeo/forms.h"

namespace patchmill {

enum class Paint {
  kRegions,    // the colour of its region, shaded
  kSlope,      // by its slope
  kCurvature,  // by the curvature of its contour
};

// The scales of slope and curvature.
struct PaintScales {
  double steep_angle = Radians(45.0);  // rad; green below it, orange to red above
  double radius = 3.0;                 // mm; curvature is full red at -1/radius, full blue at 1/radius
};

// `color` ("#rrggbb", else grey) shaded by a light from the upper left; darkened by half if there is no
// normal.
std::string Lit(const std::string& color, const SurfaceJet& jet);

// `slope` is in rad, from 0 to pi/2.
std::string SlopeColor(double slope, const PaintScales& scales);
// The colour of a contour's curvature (1/mm, for the upward normal): red if it bends outward, blue if inward.
std::string CurvatureColor(double curvature, const PaintScales& scales);

// The colour of a point by its slope or by the curvature of its contour; grey where there is none.
std::string PaintedColor(Paint paint, const SurfaceJet& jet, const PaintScales& scales);

}  // namespace patchmill
