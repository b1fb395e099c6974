// Measures how much of a part a tool sees that comes along one of the six axes of its model.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/network/patch_model.h"
#include "core/surface/surface.h"

namespace patchmill {

// The figures if this axis of the model pointed up. They are sampled: areas are good to some percent.
struct UpDirection {
  UpAxis up = UpAxis::kZ;
  double facing_area = 0.0;  // mm^2, where the normal u x v is less than 89 degrees off the axis
  double hidden_area = 0.0;  // mm^2 of that, above which another part of the surface lies: undercuts
  int level_face_count = 0;  // plane faces that the axis is normal to, on their outer side
};

// One for each axis, in the order of UpAxis. The normals of all faces must point out of the body, as in CAD
// files: the result is empty for a model without faces. `placement`: how the surface was placed; the axes are
// those of the model before that. Memory: a grid of 400 x 400 numbers. Errors: those of `run`.
absl::StatusOr<std::vector<UpDirection>> MeasureUpDirections(const Surface& surface,
                                                             const Placement& placement,
                                                             const RunContext& run);

// The axis that shows most. Of several that show as much to a percent of all area, the first. `directions` is
// not empty.
UpAxis BestUp(const std::vector<UpDirection>& directions);

}  // namespace patchmill
