// Outlines of regions: sides between triangles of different regions, put together and bent onto the true
// curves.
#pragma once

#include <span>
#include <vector>

#include <absl/status/statusor.h>

#include "cam/region/seams.h"
#include "core/base/run_context.h"

namespace patchmill {

// Closed polylines on the surface for every region (`region_of[piece][triangle]`, -1 none), the region on the
// left in the sense of the triangles. Sides on the zero curve or limit of a field are refined to `tolerance`
// (mm). Pieces of outline that do not meet end to end (seams cut differently on their two sides) are joined
// to the nearest open end. CANCELLED, DEADLINE_EXCEEDED from `run`.
absl::StatusOr<std::vector<std::vector<std::vector<Vec3>>>> RegionBorders(
    const Surface& surface, const std::vector<SplitMesh>& meshes, const std::vector<Adjacency>& adjacency,
    const std::vector<std::vector<int>>& region_of, std::size_t region_count,
    std::span<const ZeroField> fields, double tolerance, const RunContext& run);

// Area (mm^2) between the chord of a side that lies on the zero curve of a smooth field and the curve itself,
// counted positive when the curve bulges out of the triangle the side belongs to. 0 for sides that are no
// border.
double LensArea(const Surface& surface, const SplitMesh& mesh, const TriangleSide& side,
                std::span<const ZeroField> fields, double tolerance);

}  // namespace patchmill
