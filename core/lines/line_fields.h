// The characteristic lines of a surface as zero curves [lines, section 2]: what to give to TraceZeroCurves.
//
// n is the unit normal along S_u x S_v of a piece, t its contour tangent. `axis`, `light` and `view` are unit
// vectors (n_f of [lines]); phi = axis . S. Where the parametrisation has no normal every field is 0.
//
//   line                   field                         zero where                   lines cross at
//   contour                ContourField(level)           phi = level                  saddles of phi, level
//   equi-slope             SlopeField(angle)             |axis . n| = cos angle       -
//   iso-brightness         BrightnessField(brightness)   light . n = brightness       -
//   silhouette             SilhouetteField(view)         view . n = 0                 -
//   the same from an eye   EyeSilhouetteField(eye)       (S - eye) . n = 0            -
//   highlight              HighlightField(plane, across) section tangent along        -
//                                                        plane x across
//   contour-inflection     ContourCurvatureField()       kappa_c = 0                  saddles of phi
//   slope-extremum         SlopeExtremumField()          the slope has an extremum    summits, pits, saddles
//
// Formulas, in this order: [lines (2)], [lines (4), (6)], [lines (6)], [lines, section 2], [lines (8)],
// [shapes (33)], [lines (10)].
//
// Planes: where a field vanishes over an area (rounding counts as zero) no line is drawn inside it.
// Umbilics are ordinary points of slope-extremum lines. Orthogonal families (flow lines and those of
// equi-slope) are no zero curves: they follow a direction instead.
#pragma once

#include "core/lines/zero_field.h"

namespace patchmill {

// phi - level (mm): contour lines. |level| is unlimited.
ZeroField ContourField(double level, const Vec3& axis = Vec3::UnitZ());

// |axis . n| - cos(angle): > 0 where the slope against the plane across `axis` is below `angle`, rad, in
// (0, pi/2). The same on both sides of a sheet, so lines run on where neighbours are turned over.
ZeroField SlopeField(double angle, const Vec3& axis = Vec3::UnitZ());

// light . n - brightness, brightness in (-1, 1). Signed: lines end where neighbours turn n over.
ZeroField BrightnessField(double brightness, const Vec3& light);

// view . n: silhouettes for parallel light or sight along `view`, vertical walls and turning points for z.
ZeroField SilhouetteField(const Vec3& view = Vec3::UnitZ());
// (S - eye) . n, mm: silhouettes seen from the point `eye`.
ZeroField EyeSilhouetteField(const Vec3& eye);
// Points where the section by a plane across `plane` runs along d = plane x across; `across` is a unit vector
// of that plane. This is [lines T26] the silhouette for the view d.
inline ZeroField HighlightField(const Vec3& plane, const Vec3& across) {
  return SilhouetteField(plane.cross(across));
}

// Normal curvature along the contour with respect to n, 1/mm [shapes (33)]: its zeros with non-zero slope
// are the inflections of contour lines. Times the sign of axis . n it is < 0 on mountains.
ZeroField ContourCurvatureField(const Vec3& axis = Vec3::UnitZ());

// Geodesic torsion along the contour, 1/mm: [lines (11)]. Zero where the
// contour tangent is a principal direction. Identically 0 on surfaces of revolution about `axis`: no lines.
ZeroField SlopeExtremumField(const Vec3& axis = Vec3::UnitZ());

}  // namespace patchmill
