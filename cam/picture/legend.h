// Draws the legend of a picture: the meaning of its colours and lines.
#pragma once

#include "cam/picture/preview.h"
#include "cam/picture/svg_writer.h"

namespace patchmill {

// Draws the dot that stands for a node, in the views and in the legend.
void DrawNode(const Vec2& at, SvgWriter& svg);

// Draws the legend as a column from `corner` (px) down.
void DrawLegend(const PreviewInput& input, const Vec2& corner, SvgWriter& svg);

}  // namespace patchmill
