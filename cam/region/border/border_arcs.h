// Bends the sides between triangles of different regions onto the true curves.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/region/split/seams.h"
#include "core/base/run_context.h"

namespace patchmill {

// The borders of a split.
struct BorderArcs {
  std::vector<std::size_t> sides;  // in the adjacency, rising: sides between different regions, open sides
  // [side]: places on the curve between its ends, in its direction; none if the side is straight.
  std::vector<std::vector<Vec2>> places;
};

// Finds all sides between different regions (`region_of[piece][triangle]`) and all open sides. A side on the
// zero curve or limit of a field is refined to `tolerance` (mm), once for both triangles. CANCELLED and
// DEADLINE_EXCEEDED from `run`.
absl::StatusOr<BorderArcs> FindBorderArcs(const Surface& surface, const std::vector<SplitMesh>& meshes,
                                          const AdjacencyList& adjacency,
                                          const std::vector<std::vector<RegionId>>& region_of,
                                          std::span<const ZeroField> fields, double tolerance,
                                          const RunContext& run);

// How much area each region gains when its borders bend from chords to arcs, mm^2. `flat` holds the areas of
// the regions' triangles, mm^2. The gains add up to 0. A sliver along a limit or a seam may be thinner than
// the error of its arcs, which would turn it inside out. Such a region keeps its chords: its arcs are removed
// from `arcs`. So no area falls below 0. CANCELLED and DEADLINE_EXCEEDED from `run`.
absl::StatusOr<std::vector<double>> BendAreas(const Surface& surface, const std::vector<SplitMesh>& meshes,
                                              const AdjacencyList& adjacency,
                                              const std::vector<std::vector<RegionId>>& region_of,
                                              const std::vector<double>& flat, const RunContext& run,
                                              BorderArcs& arcs);

// Points on the surface along each border side, its ends included. Same index as BorderArcs::sides.
using BorderPoints = std::vector<std::vector<Vec3>>;

// Puts points along the arcs. Between two of their places the border is straight in the parameters; there it
// gets so many points that chords deviate by at most `tolerance` (mm). CANCELLED and DEADLINE_EXCEEDED from
// `run`.
absl::StatusOr<BorderPoints> FindBorderPoints(const Surface& surface, const std::vector<SplitMesh>& meshes,
                                              const AdjacencyList& adjacency, const BorderArcs& arcs,
                                              double tolerance, const RunContext& run);

}  // namespace patchmill
