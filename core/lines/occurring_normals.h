// Chooses families of highlight lines and of brightnesses from the normals that occur on a surface. On a
// flat panel, whose normals differ by some degrees, fixed directions and levels show no line at all.
#pragma once

#include <vector>

#include "core/lines/line_family.h"
#include "core/patch/patch.h"
#include "core/surface/surface.h"

namespace patchmill {

struct OccurringNormal {
  Vec3 normal = Vec3::UnitZ();  // unit, along S_u x S_v
  double area = 0.0;            // that it stands for
};
using OccurringNormals = std::vector<OccurringNormal>;

// The normals in the middles of 3 x 3 parts of each piece. Places without a normal are left out.
OccurringNormals NormalsOf(const Surface& surface);
// The same of patches, of triangles at six places.
OccurringNormals NormalsOf(const std::vector<Patch>& patches);

// The axis about which the planes turn is the one along which the normals have the least component, so that
// the angle of the planes tells normals apart best. `across` is nearest to all normals.
HighlightLines ChooseHighlights(const OccurringNormals& normals);

// The light comes from halfway between the normals' middle and the direction in which they spread most.
// There the brightness changes most from normal to normal.
BrightnessLines ChooseBrightness(const OccurringNormals& normals);

// `count` (>= 1) levels, evenly spread between those of the normals but for a hundredth of the area at
// either end; ascending, highlights from the first one on around half a turn and in [0, pi). Empty for
// other families and where all normals have one level to 1e-9.
std::vector<double> LevelsOfNormals(const OccurringNormals& normals, const LineFamily& family, int count);

}  // namespace patchmill
