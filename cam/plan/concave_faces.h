// The concave faces of a part, by kind and radius: which ball reaches all of them.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/surface/face_figures.h"

namespace patchmill {

struct ConcaveFaces {
  SurfaceKind kind = SurfaceKind::kUnknown;
  double radius = 0.0;        // mm, the smallest of these faces: a ball of at most this radius reaches them
  std::vector<FaceId> faces;  // the tightest one first
  double area = 0.0;          // mm^2
};

// Faces of one kind whose smallest radii agree to 1e-3 are one group. Ordered by kind, then by radius. The
// air is on the side of u x v of each face, as in CAD files; the radii are estimates from above
// (ConcaveRadiiOfFaces). Empty for a model without faces. Errors: those of `run`.
// `figures`: MeasureFaces(surface).
absl::StatusOr<std::vector<ConcaveFaces>> GroupConcaveFaces(const Surface& surface,
                                                            const std::vector<FaceFigures>& figures,
                                                            const RunContext& run);

}  // namespace patchmill
