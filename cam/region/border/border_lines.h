// Joins the borders of regions to lines, each of one kind and between two regions, and finds the nodes where
// lines meet.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/region/border/border_arcs.h"
#include "cam/region/map/region_map.h"
#include "cam/region/merge/triangle_regions.h"

namespace patchmill {

struct BorderNet {
  std::vector<BorderLine> lines;
  std::vector<Vec3> nodes;
};

// Joins all border sides, each once, along their points. Kind, slope and reason of the `regions` are read.
// The kind of a line follows from the field on whose zero curve or limit it lies; a field that differs across
// the line is preferred.
//
// Ends nearer to each other than twice the join tolerance are one place. Where a seam is cut differently on
// its two sides, a line continues across the gap, which may be as long as the longest side on a seam. Lines
// are ordered by their first side, nodes by the lines that end there. CANCELLED and DEADLINE_EXCEEDED from
// `run`.
absl::StatusOr<BorderNet> FindBorderLines(const SplitSurface& split, const TriangleRegions& triangles,
                                          const BorderPoints& border, const std::vector<Region>& regions,
                                          const RunContext& run);

}  // namespace patchmill
