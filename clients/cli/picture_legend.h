// Draws the legend of a picture: name and size of the part, the meaning of colours and lines, a scale in
// mm and the axes.
#pragma once

#include <string>
#include <vector>

#include "clients/cli/picture_shading.h"
#include "clients/render/camera.h"
#include "clients/render/image.h"
#include "patchmill/v1/report.pb.h"
#include "patchmill/v1/tool.pb.h"

namespace patchmill::cli {

struct Legend {
  std::string title;
  render::Box part;
  v1::Tool tool;
  v1::Outcome outcome = v1::OUTCOME_UNSPECIFIED;  // unspecified without a program
  Shading shading;
  std::vector<Swatch> lines;  // of passes and borders
  std::string view;           // "iso"
};

// The legend is a column at the right of the picture; the part is drawn from 0 to `left_px`.
struct LegendPlace {
  int left_px = 0, width_px = 0;
};
LegendPlace PlaceOfLegend(render::PixelSize picture);

// The whole picture: the drawing, taken by `camera`, with scale and axes in it and the legend beside it.
// Rows that find no room are counted in the last one ("and 12 more").
render::Image WithLegend(const render::Image& drawing, const render::Camera& camera, const Legend& legend,
                         render::PixelSize size);

}  // namespace patchmill::cli
