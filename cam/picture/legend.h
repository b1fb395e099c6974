// What the colours and lines of a picture mean.
#pragma once

#include "cam/picture/preview.h"
#include "cam/picture/svg_writer.h"

namespace patchmill {

// The dot that stands for a node, in the views as in the legend.
void DrawNode(const Vec2& at, SvgWriter& svg);

// A column from `corner` (px) down.
void DrawLegend(const PreviewInput& input, const Vec2& corner, SvgWriter& svg);

}  // namespace patchmill
