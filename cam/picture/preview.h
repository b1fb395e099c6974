// The part from above and isometric as SVG: regions, their borders by kind, nodes, unreachable parts, passes
// by kind, links, open edges, scale, legend; if wanted, slope and curvature from above.
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
  std::string name;   // of the legend: "3 mountain steep 412.3 mm2"
  std::string label;  // on the surface, where it has room and no passes run: "3"
  std::string color;  // CSS
  double area = 0.0;  // mm^2: of many the legend has the largest
};

// Lines on the surface, drawn where they can be seen.
struct PreviewLines {
  std::string name;   // of the legend
  std::string color;  // CSS
  std::vector<std::vector<Vec3>> polylines;
  std::optional<Paint> on;  // drawn again where slope or curvature are shown
};

struct PreviewInput {
  const Surface* surface = nullptr;    // required
  const Toolpath* toolpath = nullptr;  // optional
  std::vector<PassKind> pass_kinds;    // by Move::pass
  std::vector<PreviewRegion> regions;
  // Region index of a point of a piece (into `regions`, -1 none); empty function: shade by slope only.
  std::function<int(const SurfacePoint&)> region_of;
  std::vector<PreviewLines> borders;  // of regions
  std::vector<Vec3> nodes;            // where borders meet
  std::vector<PreviewLines> lines;
  bool shadings = false;             // two more views: slope and curvature of contours, from above
  PaintScales scales;                // of these
  Vec3 program_zero = Vec3::Zero();  // marked with a cross
  std::string title;
  std::vector<std::string> notes;  // lines under the title: outcome, gouge, leftover, ...
};

// At most about `max_bytes` (moves are thinned for display, never in the program).
std::string DrawPreview(const PreviewInput& input, std::size_t max_bytes = 8'000'000);

}  // namespace patchmill
