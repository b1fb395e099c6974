// Cuts a face of many corners into pieces of three and four [crossing, section 4].
#pragma once

#include <functional>
#include <vector>

#include "core/base/vec.h"

namespace patchmill {

// Most corners of a face that is cut.
inline constexpr int kMaxCornersToCut = 32;

struct CutCorner {
  Vec3 position = Vec3::Zero(), normal = Vec3::Zero();
  Vec3 next = Vec3::Zero(), previous = Vec3::Zero();  // directions of the two sides, away from the corner
};

// Corners of each piece, in the order of the face. The face itself if no cut is needed; empty if there is
// none that leaves pieces with corners below 180 degrees. `allowed(i, j)`: whether an edge may join two
// corners. A piece of four right angles is best, a triangle costs a little; corners near 180 degrees are
// cut.
std::vector<std::vector<int>> ChooseCuts(const std::vector<CutCorner>& corners,
                                         const std::function<bool(int, int)>& allowed);

}  // namespace patchmill
