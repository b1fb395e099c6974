// The first stage of trimming: a face as soon as nothing but the faces beside it matters any more.
#pragma once

#include <variant>
#include <vector>

#include <absl/status/status.h>

#include "core/base/run_context.h"
#include "core/brep/brep_model.h"
#include "core/trim/border_trace.h"
#include "core/trim/carrier_grid.h"
#include "core/trim/plane_strips.h"

namespace patchmill {

// A face on a curved surface: its carriers, and where its edges run on them.
struct GridTrace {
  CarrierGrid grid;
  BorderTrace border;
  double surface_error = 0.0;  // mm, by how much the carriers may differ from the file's surface
};

// mm: how far the carriers may differ from a spline whose degrees are too high for strips, where the border
// needs strips.
inline constexpr double kSurfaceTolerance = 1e-5;

struct TracedFace {
  // Why the face is lost; or the patches of a face on a plane, which needs nothing more; or the trace.
  std::variant<absl::Status, PlanePatches, GridTrace> result;
  // The parameters at which each edge use has to be cut, in the order of the uses over all loops.
  std::vector<std::vector<double>> breaks;

  const GridTrace* grid() const { return std::get_if<GridTrace>(&result); }
  double gap() const;  // mm, largest distance of an edge from the surface; 0 for a lost face
};

TracedFace TraceFace(const BrepFace& face, const EdgeCurveTable& curves, const RunContext& run);

}  // namespace patchmill
