// Estimates how tight a surface is hollow: the radius of the largest ball that fits into each place.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

struct ConcaveSpot {
  double radius = kInfinity;  // mm, 1 / largest normal curvature towards the air; infinity: nowhere concave
  SurfacePoint at;
};

// All radii are found by sampling every leaf and refining the best places by a pattern search. They are
// estimates from above, not bounds, because the curvature may peak between samples. A place does not count
// where rounding alone could make up a hundredth of its curvature: a plane is nowhere concave, and beside a
// pole, or along a needle, the parameters say nothing about the shape. Cost: about 10 evaluations a leaf,
// parallel over blocks of leaves. Errors: those of `run`.

// The smallest concave radius that a tool from above meets. The air is on the side of the upward normal. An
// upright place counts if its air side is known; an overhanging one does not.
absl::StatusOr<ConcaveSpot> SmallestConcaveRadius(const Surface& surface, const RunContext& run);

// The smallest concave radius of each face of the surface's model. The air is on the side of u x v of the
// patches, as faces of closed bodies in CAD files have it, wherever that side looks.
absl::StatusOr<std::vector<ConcaveSpot>> ConcaveRadiiOfFaces(const Surface& surface, const RunContext& run);

}  // namespace patchmill
