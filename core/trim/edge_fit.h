// The second stage of trimming: an edge cut into parts that all faces beside it follow.
#pragma once

#include <vector>

#include "core/base/run_context.h"
#include "core/trim/border_trace.h"
#include "core/trim/carrier_grid.h"

namespace patchmill {

// An edge on one of the surfaces beside it, where it is no iso-parametric line.
struct EdgeSide {
  const CarrierGrid* grid = nullptr;
  const UseTrace* trace = nullptr;
};

// Cuts the edge at the `breaks` (any order, ends included or not), then halves parts until the graphs on all
// sides follow it: to half the tolerance, or to half of its own distance from the surface if that is more.
// After 14 halvings a part stays as it is, with its error. Returns the graphs of each side, part by part
// along the curve. The parts are the same on all sides, so that faces have their corners at the same places.
std::vector<std::vector<FittedGraph>> FitEdge(const SpannedCurve& curve, const std::vector<EdgeSide>& sides,
                                              std::vector<double> breaks, double tolerance,
                                              const RunContext& run);

// Parameters at which the curve is not twice differentiable.
std::vector<double> SharpKnots(const BrepCurve& curve);

}  // namespace patchmill
