// The sides between triangles of different regions, bent onto the true curves.
#pragma once

#include <span>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/region/seams.h"
#include "core/base/run_context.h"

namespace patchmill {

// [adjacency]: places on the curve between the ends of the side, in its direction; none where the side is
// straight, or no border.
using BorderArcs = std::vector<std::vector<Vec2>>;

// Of all sides with different regions on them (`region_of[piece][triangle]`). What lies on the zero curve or
// limit of a field is refined to `tolerance` (mm), once for both triangles. CANCELLED, DEADLINE_EXCEEDED from
// `run`.
absl::StatusOr<BorderArcs> FindBorderArcs(const Surface& surface, const std::vector<SplitMesh>& meshes,
                                          const std::vector<Adjacency>& adjacency,
                                          const std::vector<std::vector<int>>& region_of,
                                          std::span<const ZeroField> fields, double tolerance,
                                          const RunContext& run);

// Area (mm^2) between the chord of a side and its arc, counted positive when the arc bulges out of the
// triangle the side belongs to.
double LensArea(const Surface& surface, const SplitMesh& mesh, const TriangleSide& side,
                const std::vector<Vec2>& arc);

// A vertex of a side: its first or its second.
const ZeroVertex& EndOf(const SplitMesh& mesh, const TriangleSide& side, int which);

}  // namespace patchmill
