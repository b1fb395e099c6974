// Draws what a program leaves over the part, from above.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "cam/picture/png_writer.h"
#include "core/base/vec.h"

namespace patchmill {

// A small quadrilateral of the surface.
struct LeftoverCell {
  std::array<Vec3, 4> corners;     // in the order of its border, placed frame
  std::optional<double> leftover;  // mm at its middle; absent where the ball does not reach
};

// `limit` > 0 (mm) is the leftover that is allowed. Colours: white beside the part, grey where the ball does
// not reach, blue below 0, green at 0 to yellow at the limit, red from there on, dark red from twice the
// limit on. A dot shows the largest leftover of all places above and below it. The longer side has 900 dots.
// Cost O(cells + dots).
PalettePicture DrawLeftover(const std::vector<LeftoverCell>& cells, double limit);

}  // namespace patchmill
