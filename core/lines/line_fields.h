// The characteristic lines of a surface as zero curves [lines, section 2]: the fields for TraceZeroCurves.
//
// n is the unit normal along S_u x S_v of a piece, t its contour tangent. `axis`, `light` and `view` are unit
// vectors (n_f of [lines]); phi = axis . S. Where the parametrisation has no normal, every field is 0.
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
// Planes: where a field vanishes over an area (rounding counts as zero), no line is drawn inside the area.
// Umbilics are ordinary points of slope-extremum lines. Orthogonal families (flow lines and the orthogonals
// of equi-slope lines) are not zero curves, because they follow a direction.
#pragma once

#include "core/lines/zero_field.h"

namespace patchmill {

// phi - level (mm), for contour lines. |level| is unlimited.
ZeroField ContourField(double level, const Vec3& axis = Vec3::UnitZ());

// axis . n| - cos(angle). It is > 0 where the slope against the plane across `axis` is below `angle` (rad, in
// (0, pi/2)). It is the same on both sides of a sheet, so lines continue where neighbours are turned over.
ZeroField SlopeField(double angle, const Vec3& axis = Vec3::UnitZ());

// light . n - brightness, with brightness in (-1, 1). It is signed, so lines end where neighbours turn n
// over.
ZeroField BrightnessField(double brightness, const Vec3& light);

// view . n, for silhouettes in parallel light or in the direction of sight `view`. For z: vertical walls and
// turning points.
ZeroField SilhouetteField(const Vec3& view = Vec3::UnitZ());
// (S - eye) . n, mm, for silhouettes seen from the point `eye`.
ZeroField EyeSilhouetteField(const Vec3& eye);
// Zero where the section by a plane across `plane` runs along d = plane x across; `across` is a unit vector
// of that plane. By [lines T26] this is the silhouette for the view d.
inline ZeroField HighlightField(const Vec3& plane, const Vec3& across) {
  return SilhouetteField(plane.cross(across));
}

// Normal curvature along the contour with respect to n, 1/mm [shapes (33)]. Its zeros with non-zero slope are
// the inflections of contour lines. Multiplied by the sign of axis . n it is < 0 on mountains.
ZeroField ContourCurvatureField(const Vec3& axis = Vec3::UnitZ());

// Geodesic torsion along the contour, 1/mm [lines (11)]. It is zero where the contour tangent is a principal
// direction. It is identically 0 on surfaces of revolution about `axis`, which have no such lines.
ZeroField SlopeExtremumField(const Vec3& axis = Vec3::UnitZ());

}  // namespace patchmill
