// Shows in a view in which order and direction passes are cut.
#pragma once

#include <vector>

#include "cam/picture/preview.h"
#include "cam/picture/svg_writer.h"
#include "cam/picture/view.h"

namespace patchmill {

// A place in the picture with the direction of the cut there.
struct PassArrow {
  Vec2 at = Vec2::Zero();         // px
  Vec2 direction = Vec2::Zero();  // unit, y down
};

// One arrow in the middle of each pass, by the passes' order. Passes shorter than 14 px in the view have
// none, and an arrow nearer than 12 px to an earlier one is left out.
std::vector<PassArrow> ArrowsOf(const Toolpath& toolpath, const View& view);

// The place (px) where the tool begins to cut each of these passes (indices, rising).
std::vector<Vec2> StartsOf(const Toolpath& toolpath, const std::vector<int>& passes, const View& view);

// Draws the arrows, and the numbers of input.section_passes at their starts, the first as 1. Starts at the
// same place share the lowest number.
void DrawPassOrder(const PreviewInput& input, const View& view, SvgWriter& svg);

}  // namespace patchmill
