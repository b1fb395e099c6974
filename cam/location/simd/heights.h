// Heights of many places at once, in the vector lanes of the processor.
#pragma once

#include <optional>
#include <span>

#include "cam/location/locator.h"

namespace patchmill {

// heights[k] = h(q[k]), as Locator::Height finds it; heights.size() must equal q.size(). Eight consecutive
// places walk the tree together, and each leaf is tested against all eight. This is fast if they lie much
// nearer to each other than R, as along a row or in a tile of a grid. Method and error are those of Height:
// proofs exclude leaves; Newton's method finds the maximum of leaves proven convex; the other leaves go
// through Height's own search and division.
//
// Within its error a height depends on its neighbours in the list, but never on the processor. The lanes are
// those of UsedInstructionSet() (core/base/instruction_set.h), and all of them give the same bits.
void Heights(const Locator& locator, std::span<const Vec2> q, std::span<std::optional<CenterPoint>> heights,
             double gap = kProofGap);

// obstacles[k] is nullopt if locator.Free(centers[k]), within the error of heights. Otherwise it is a surface
// point in the ball or above it, not always the deepest one. The method is that of Heights, eight consecutive
// centres at once, with the same bits everywhere. Nothing that lies below the centres is visited.
void FindObstacles(const Locator& locator, std::span<const Vec3> centers,
                   std::span<std::optional<SurfacePoint>> obstacles);

}  // namespace patchmill
