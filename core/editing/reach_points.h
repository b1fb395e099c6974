// Moves places of quads to where goals want them, by bulges of their faces [editing, section 7].
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/editing/goals.h"
#include "core/joining/join_network.h"

namespace patchmill {

// The place of a quad nearest to `p`: the best of a grid, then Gauss-Newton inside the face.
Vec2 NearestPlace(const PatchShape& quad, const Vec3& p);

// Adds bulges to `faces`, the faces of the network that `joined` was made from. One bulge stands at each
// place of a goal. Their vectors solve the least squares of all goals together, with the smallest sum of
// squares. The border of the faces stays. INVALID_ARGUMENT "<at>.points[2].face = 7; ..." for a goal that
// cannot be.
absl::StatusOr<std::vector<ReachedGoal>> ReachPoints(const Goals& goals, const JoinedNetwork& joined,
                                                     std::vector<NetworkFace>& faces, const std::string& at);

}  // namespace patchmill
