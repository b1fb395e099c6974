// Heights of many places at once, in the processor's vector lanes.
#pragma once

#include <optional>
#include <span>

#include "cam/location/locator.h"

namespace patchmill {

// heights[k] = h(q[k]), as Locator::Height finds it; heights.size() == q.size(). Eight consecutive places
// walk the tree together, a leaf meets all eight at once: fast when they lie much nearer to each other than
// R, as along a row or in a tile of a grid. The method is that of Height, with its error: proofs exclude
// leaves, Newton finds the maximum of those proven convex, what is neither goes through Height's own search
// and division.
//
// A height depends on its neighbours in the list within its error alone, never on the processor:
// the lanes are those of UsedInstructionSet() (core/base/instruction_set.h), all of which give the same bits.
void Heights(const Locator& locator, std::span<const Vec2> q, std::span<std::optional<CenterPoint>> heights,
             double gap = kProofGap);

// obstacles[k]: nothing where locator.Free(centers[k]), within the error of heights, else a point of the
// surface in the ball or above it, not always the one that is most in the way. The same way, with the same
// bits everywhere: eight consecutive centres at once, and nothing looked at that lies below them.
void FindObstacles(const Locator& locator, std::span<const Vec3> centers,
                   std::span<std::optional<SurfacePoint>> obstacles);

}  // namespace patchmill
