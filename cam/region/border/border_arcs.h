// Bends the sides between triangles of different regions onto the true curves.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/region/split/seams.h"
#include "core/base/run_context.h"
#include "core/base/typed_id.h"

namespace patchmill {

// The borders of a split.
struct BorderArcs {
  std::vector<std::size_t> sides;  // in the adjacency, rising: sides between different regions, open sides
  // [side]: places on the curve between its ends, in its direction; none if the side is straight.
  std::vector<std::vector<Vec2>> places;
};

// Finds all sides between different regions and all open sides. A side on the zero curve or limit of one of
// the `fields` of the split is refined to `tolerance` (mm), once for both triangles. The ids in `region_of`
// need not be final: only equal ones are the same region. CANCELLED and DEADLINE_EXCEEDED from `run`.
absl::StatusOr<BorderArcs> FindBorderArcs(const SplitSurface& split, const PerTriangle<RegionId>& region_of,
                                          std::span<const ZeroField> fields, double tolerance,
                                          const RunContext& run);

// The arcs of the borders, less those that would make an area negative, and what they change in the areas.
struct BentBorders {
  BorderArcs arcs;
  std::vector<double> gained;  // [region]: mm^2 that it gains as its borders bend from chords to arcs
};

// Measures how the arcs change the areas of the regions. `flat` [region] holds the areas of the triangles,
// mm^2. The gains add up to 0. A sliver along a limit or a seam may be thinner than the error of its arcs;
// with them its area would be negative. Such a region keeps its chords, and the result has none of its arcs.
// So no area falls below 0. CANCELLED and DEADLINE_EXCEEDED from `run`.
absl::StatusOr<BentBorders> BendAreas(const SplitSurface& split, const PerTriangle<RegionId>& region_of,
                                      const std::vector<double>& flat, BorderArcs arcs,
                                      const RunContext& run);

// The borders of a split as points on the surface.
struct BorderPoints {
  std::vector<std::size_t> sides;         // those of the arcs
  std::vector<std::vector<Vec3>> points;  // [side]: along it, its ends included
};

// Puts points along the arcs. Between two of their places the border is straight in the parameters; there it
// gets so many points that chords deviate by at most `tolerance` (mm). CANCELLED and DEADLINE_EXCEEDED from
// `run`.
absl::StatusOr<BorderPoints> FindBorderPoints(const SplitSurface& split, const BorderArcs& arcs,
                                              double tolerance, const RunContext& run);

}  // namespace patchmill
