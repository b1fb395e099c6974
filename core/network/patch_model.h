// The model as given by a client or a file.
#pragma once

#include <optional>
#include <vector>

#include "core/patch/patch.h"

namespace patchmill {

struct PatchModel {
  std::vector<Patch> patches;
  std::optional<double> join_tolerance;  // mm; default 1e-5 of the box diagonal
};

// How the model lies on the machine: scale first, then `up`, then translation (DESIGN 5).
enum class UpAxis { kZ, kY, kX, kNegZ, kNegY, kNegX };
struct Placement {
  double scale = 1.0;  // > 0
  UpAxis up = UpAxis::kZ;
  Vec3 translation = Vec3::Zero();
};
Vec3 Place(const Placement& placement, const Vec3& p);
PatchModel Place(const Placement& placement, const PatchModel& model);

// Everything that makes a single patch unusable: sizes, degrees, knots, weights, finite numbers, magnitude.
// One error diagnostic per fault with patch index and reason; empty when the model is sound. Cost O(points).
std::vector<struct Diagnostic> ValidateModel(const PatchModel& model);

Box3 ControlBox(const PatchModel& model);  // of all control points

}  // namespace patchmill
