// The derivatives across the middles of the edges of a G2 network, estimated over the whole network [joining,
// section 10].
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/joining/curvature_joint.h"
#include "core/joining/face_frame.h"

namespace patchmill {

// For each edge, the derivatives into its first and its second face. No value where the network leaves
// nothing to estimate: for a face without a joint of equal curvature, and for a face beside a smooth edge
// that is no such joint (fair_joints.h).
using FairMiddles = std::vector<std::array<std::optional<CrossEnd>, 2>>;

// Depends on the curves alone, not on the controls. So a control changes the two faces at its edge only.
// Cost as EstimateTwists.
FairMiddles EstimateMiddles(const CurvedNetwork& curved);

}  // namespace patchmill
