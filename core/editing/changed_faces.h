// Finds the faces of a network that edits have changed.
#pragma once

#include <vector>

#include "core/joining/join_network.h"

namespace patchmill {

// Faces whose patches differ in any bit from those before, rising. Faces that edits have added count as
// changed. If `before` makes no patches, all faces do.
std::vector<int> ChangedFaces(const JoinedNetwork& before, const JoinedNetwork& after);

}  // namespace patchmill
