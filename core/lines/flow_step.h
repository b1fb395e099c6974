// One step along a flow, within a piece or over its border.
#pragma once

#include <optional>

#include "core/lines/flow_lines.h"

namespace patchmill {

// A place on a line with its unit tangent.
struct FlowPlace {
  SurfacePoint at;
  Vec3 tangent = Vec3::Zero();
  Vec3 normal = Vec3::UnitZ();
  double value = 0.0;     // of the flow's function
  double gradient = 0.0;  // its length
};

// `sign` +1 follows the flow, -1 goes against it. nullopt at a singular point.
std::optional<FlowPlace> PlaceOn(const Surface& surface, const FlowParams& params, PieceId piece, double u,
                                 double v, double sign);

struct FlowStep {
  FlowPlace place;
  bool at_border = false;  // of the piece
};
// A Runge-Kutta step of at most `length` mm (in), shortened until it keeps to the tolerance or ends at the
// border of the piece; `length` (out) is what to try next. nullopt where the flow ends.
std::optional<FlowStep> Advance(const Surface& surface, const FlowParams& params, const FlowPlace& from,
                                double sign, double* length);

// Where a line that has reached its piece's border goes on: nullopt at the surface's.
std::optional<FlowPlace> CrossBorder(const Surface& surface, const FlowParams& params, const FlowPlace& from,
                                     double sign);

}  // namespace patchmill
