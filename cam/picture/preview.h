// Draws the part from above and isometric as SVG: regions, their borders by kind, nodes, unreachable areas,
// passes by kind, their order and direction, links, open edges, scale and legend. On request it adds views of
// slope and curvature.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cam/picture/paint.h"
#include "cam/toolpath/cutter_path.h"
#include "cam/toolpath/toolpath.h"
#include "core/surface/surface.h"

namespace patchmill {

struct PreviewRegion {
  std::string name;   // in the legend: "3 mountain steep 412.3 mm2"
  std::string label;  // on the surface, if there is room and no passes are drawn: "3"
  std::string color;  // CSS
  double area = 0.0;  // mm^2; if there are many regions, the legend shows the largest ones
};

// Lines on the surface, drawn where they are not hidden.
struct PreviewLines {
  std::string name;   // in the legend
  std::string color;  // CSS
  std::vector<std::vector<Vec3>> polylines;
  std::optional<Paint> on;  // the view by slope or curvature in which the lines are drawn, too
};

struct PreviewInput {
  const Surface* surface = nullptr;      // required
  const Toolpath* toolpath = nullptr;    // optional
  std::vector<PassKind> pass_kinds;      // index: Move::pass
  std::vector<int> section_passes;       // first pass of each section of the program, rising
  std::string region_title = "regions";  // what the legend calls them
  std::vector<PreviewRegion> regions;
  // The region of a surface point (index into `regions`, or -1). If empty, the surface is only shaded.
  std::function<int(const SurfacePoint&)> region_of;
  std::vector<PreviewLines> borders;  // of regions
  std::vector<Vec3> nodes;            // where borders meet
  std::vector<PreviewLines> lines;
  bool shadings = false;             // adds two views from above: slope and curvature of contours
  PaintScales scales;                // of these two views
  Vec3 program_zero = Vec3::Zero();  // a cross marks it
  std::string title;
  std::vector<std::string> notes;  // lines under the title: outcome, gouge, leftover, ...
};

// The picture has at most about `max_bytes`: moves are thinned in the picture, never in the program.
std::string DrawPreview(const PreviewInput& input, std::size_t max_bytes = 8'000'000);

}  // namespace patchmill
