// Size, inclination and place of the faces of a surface.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/surface/surface.h"

namespace patchmill {

// The pieces of each face of the surface's model, ascending.
std::vector<std::vector<PieceId>> PiecesOfFaces(const Surface& surface);

struct FaceFigures {
  int patch_count = 0;
  double area = 0.0;  // mm^2, to about 1e-9 of it
  // Rad, [0, pi]: angles between u x v and +Z. 0 is a level face that looks up. From 17 x 17 places of each
  // piece.
  double tilt_min = 0.0, tilt_max = 0.0;
  Box3 box;  // mm, of these places
};

// As the faces of the surface's model. A face without patches has no area and an empty box. Parallel over
// faces; the errors are those of `run`.
absl::StatusOr<std::vector<FaceFigures>> MeasureFaces(const Surface& surface, const RunContext& run);

}  // namespace patchmill
