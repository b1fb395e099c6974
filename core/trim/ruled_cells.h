// Cuts a face on a carrier of straight rulings into patches that keep the rulings: cylinders, cones,
// extrusions [trimming, section 5].
//
// A ball touches such a surface along a ruling, or along a line that the patch's own parameters follow.
// Proofs along it are quick only where the patch has that line as one of its parameter lines.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/trim/carrier_grid.h"
#include "core/trim/grid_graph.h"

namespace patchmill {

// Whether the grid has one row of carriers that are linear in v, of a degree in u low enough.
bool IsRuled(const CarrierGrid& grid);

struct RuledPatches {
  std::vector<BernsteinNet> nets;
  double moved = 0.0;  // mm, along u: corners of the border closer than 1e-5 mm to each other get one wall
};
// The patches of one carrier, with v along the rulings. `border`: the border graphs within the carrier, in
// grid coordinates. The degrees are at most (3 p + 3, 1). FAILED_PRECONDITION if graphs cross each other.
absl::StatusOr<RuledPatches> CutRuledCarrier(const CarrierGrid& grid, GridCell cell,
                                             const std::vector<GridGraph>& border, const RunContext& run);

}  // namespace patchmill
