// Families of characteristic lines as values: one field per level (line_fields.h).
#pragma once

#include <variant>
#include <vector>

#include "core/lines/zero_field.h"
#include "core/surface/surface.h"

namespace patchmill {

// Directions are unit vectors. The comments say what a level is.
struct ContourLines {
  Vec3 axis = Vec3::UnitZ();  // level: axis . S, mm
};
struct EquiSlopeLines {
  Vec3 axis = Vec3::UnitZ();  // level: slope against the plane across the axis, rad, in (0, pi/2)
};
struct BrightnessLines {
  Vec3 light = Vec3::UnitZ();  // level: light . n, in (-1, 1)
};
struct SilhouetteLines {
  Vec3 view = Vec3::UnitZ();  // no levels
};
struct EyeSilhouetteLines {
  Vec3 eye = Vec3::Zero();  // mm; no levels
};
struct HighlightLines {
  Vec3 plane = Vec3::UnitZ();   // level: angle by which `across` is turned about `plane`, rad
  Vec3 across = Vec3::UnitX();  // at right angles to `plane`
};
struct ContourInflectionLines {
  Vec3 axis = Vec3::UnitZ();  // no levels
};
struct SlopeExtremumLines {
  Vec3 axis = Vec3::UnitZ();  // no levels
};
using LineFamily =
    std::variant<ContourLines, EquiSlopeLines, BrightnessLines, SilhouetteLines, EyeSilhouetteLines,
                 HighlightLines, ContourInflectionLines, SlopeExtremumLines>;

bool HasLevels(const LineFamily& family);

// `level` has no effect for a family without levels.
ZeroField FieldOf(const LineFamily& family, double level);

// About `count` (>= 1) levels over the range of the surface. Contours lie at round multiples (1, 2 or 5 times
// a power of ten) of axis . (S - origin), slopes at round shares of 90 degrees. Brightnesses are spread
// evenly in (-1, 1), highlights evenly over half a turn. There are at most `count`. There are none for a
// family without levels, or for a surface that is flat across the axis.
std::vector<double> ChooseLevels(const Surface& surface, const LineFamily& family, int count,
                                 const Vec3& origin = Vec3::Zero());

}  // namespace patchmill
