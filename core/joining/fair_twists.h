// The twists of the bicubic surfaces that the curves of a G2 network suggest, over the whole network
// [joining, section 10].
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/joining/fair_joints.h"

namespace patchmill {

using FaceTwists = std::vector<std::array<Vec3, 4>>;  // of each face, at its corners

// One sparse linear least-squares problem, the same for x, y and z, for the faces of `joints`. The other
// faces have zeros. The result is the same to the bit for any number of threads. nullopt if no face takes
// part and if the result is not finite. For a sheet of n faces the time grows as n^1.5 at most, the memory
// as n log n.
std::optional<FaceTwists> EstimateTwists(const CurvedNetwork& curved, const FairJoints& joints);

}  // namespace patchmill
