// One step along a flow, within a piece or over its border.
#pragma once

#include <optional>

#include "core/lines/flow_lines.h"

namespace patchmill {

// A place on a line, with its unit tangent and the unit normal of the surface.
struct FlowPlace {
  SurfacePoint at;
  Vec3 tangent = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();
  double value = 0.0;     // value of the flow's function; 0 for kAlongCurvature
  double gradient = 0.0;  // length of its gradient
  // For kAlongCurvature: the direction is that of the larger curvature. Within a piece this changes only
  // where a step has passed an umbilic.
  bool of_max = false;
};

// A flow on a surface and the way along it. It refers to both.
struct Flow {
  const Surface& surface;
  const FlowParams& params;
  double sign = 1.0;  // +1 follows the flow, -1 runs against it; no effect for kAlongCurvature
  // For kAlongCurvature: of the four principal directions, the line follows the one nearest to this vector.
  // Zero: that of the smaller curvature, in either sense.
  Vec3 heading = Vec3::Zero();
};

// nullopt at a singular point.
std::optional<FlowPlace> PlaceOn(const Flow& flow, PieceId piece, double u, double v);

struct FlowStep {
  FlowPlace place;
  bool at_border = false;  // the place lies on the border of the piece
};
// A Runge-Kutta step of at most `length` mm (in). It is shortened until it meets the tolerance or ends at the
// border of the piece. `length` (out) is the length to try next. nullopt where the flow ends.
std::optional<FlowStep> Advance(const Flow& flow, const FlowPlace& from, double* length);

// The place where a line continues after it has reached its piece's border. nullopt at the border of the
// surface.
std::optional<FlowPlace> CrossBorder(const Flow& flow, const FlowPlace& from);

}  // namespace patchmill
