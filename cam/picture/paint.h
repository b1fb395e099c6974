// What colour a point of the surface has in a view.
#pragma once

#include <string>

#include "core/diffgeo/forms.h"

namespace patchmill {

enum class Paint {
  kRegions,    // of its region, in the light
  kSlope,      // by its slope
  kCurvature,  // by the curvature of its contour
};

// How the scales of slope and curvature are laid out.
struct PaintScales {
  double steep_angle = Radians(45.0);  // rad: green below it, orange to red above
  double radius = 3.0;                 // mm: curvature is full red at -1/radius, full blue at 1/radius
};

// `color` ("#rrggbb", else grey) under a light from the upper left; grey where there is no normal.
std::string Lit(const std::string& color, const SurfaceJet& jet);

// `slope` in rad, 0 to pi/2.
std::string SlopeColor(double slope, const PaintScales& scales);
// Of the curvature of a contour (1/mm, upward normal): red where it bends outward, blue inward.
std::string CurvatureColor(double curvature, const PaintScales& scales);

// Of a point by its slope or the curvature of its contour; grey where there is none.
std::string PaintedColor(Paint paint, const SurfaceJet& jet, const PaintScales& scales);

}  // namespace patchmill
