// The sides between triangles of different regions, bent onto the true curves.
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
  std::vector<std::size_t> sides;  // of the adjacency, rising: those with different regions on them
  // Of each: places on the curve between its ends, in its direction; none where it is straight.
  std::vector<std::vector<Vec2>> places;
};

// Of all sides with different regions on them (`region_of[piece][triangle]`). What lies on the zero curve or
// limit of a field is refined to `tolerance` (mm), once for both triangles. CANCELLED, DEADLINE_EXCEEDED from
// `run`.
absl::StatusOr<BorderArcs> FindBorderArcs(const Surface& surface, const std::vector<SplitMesh>& meshes,
                                          const AdjacencyList& adjacency,
                                          const std::vector<std::vector<int>>& region_of,
                                          std::span<const ZeroField> fields, double tolerance,
                                          const RunContext& run);

// What the areas of regions, `flat` (mm^2, of their triangles), gain when borders bend from chords to arcs;
// the gains add up to nothing. Slivers along a limit or a seam may be thinner than their arcs are found to be
// apart: the arcs of a region that these would turn inside out are taken out of `arcs`, and its borders stay
// chords, so that no area is below 0. CANCELLED, DEADLINE_EXCEEDED from `run`.
absl::StatusOr<std::vector<double>> BendAreas(const Surface& surface, const std::vector<SplitMesh>& meshes,
                                              const AdjacencyList& adjacency,
                                              const std::vector<std::vector<int>>& region_of,
                                              const std::vector<double>& flat, const RunContext& run,
                                              BorderArcs& arcs);

// The borders on the surface, each from end to end (as many as BorderArcs has).
using BorderPoints = std::vector<std::vector<Vec3>>;

// Along the arcs, and, where these are straight in the parameters, so dense that chords keep to `tolerance`
// (mm). CANCELLED, DEADLINE_EXCEEDED from `run`.
absl::StatusOr<BorderPoints> FindBorderPoints(const Surface& surface, const std::vector<SplitMesh>& meshes,
                                              const AdjacencyList& adjacency, const BorderArcs& arcs,
                                              double tolerance, const RunContext& run);

}  // namespace patchmill
