// Cuts the inside of a face into rectangles and strips of its carriers' parameters.
//
// A carrier's square is halved at ends of border graphs until each cell holds either no graph, or only graphs
// that run from one side of the cell to the opposite one, all along the same axis. What lies between two of
// those, one above the other, is a strip [trimming,
// section 4].
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/trim/carrier_grid.h"
#include "core/trim/grid_graph.h"

namespace patchmill {

struct FacePatches {
  std::vector<BernsteinNet> nets;  // by carrier, then in the order of the cuts
  double dropped_area = 0.0;       // mm^2, of strips thinner than 1e-6 mm
  double border_error = 0.0;       // mm, by how much the cuts moved the border
};

// `border`: closed curves in grid coordinates, each graph within one carrier. A place is inside if a ray from
// it crosses them an odd number of times. `tolerance`: mm by which a graph may be moved when it is taken as a
// graph of its other coordinate. Unless all graphs are level, LargestStripDegree of the carriers must be at
// least 1. FAILED_PRECONDITION if graphs cross each other.
absl::StatusOr<FacePatches> CutFace(const CarrierGrid& grid, const std::vector<GridGraph>& border,
                                    double tolerance, const RunContext& run);

// Whether the place lies inside closed curves; graphs of other columns of carriers may be left out.
bool InsideBorder(const std::vector<GridGraph>& border, const Vec2& place);

}  // namespace patchmill
