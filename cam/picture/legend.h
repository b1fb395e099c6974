// What the colours and lines of a picture mean.
#pragma once

#include "cam/picture/preview.h"
#include "cam/picture/svg_writer.h"

namespace patchmill {

// A column from `corner` (px) down.
void DrawLegend(const PreviewInput& input, const Vec2& corner, SvgWriter& svg);

}  // namespace patchmill
