// The highest surface point in a vertical column: the obstacle for a cylinder around the tool's axis.
#pragma once

#include <optional>

#include "core/surface/surface.h"

namespace patchmill {

// All points nearer in plan than `radius` to the segment from a to b (mm). With a = b the column is circular.
struct Column {
  Vec2 a = Vec2::Zero(), b = Vec2::Zero();
  double radius = 0.0;
};

// A surface point in the column that is higher than `above` (mm, may be -infinity). It is at most `tolerance`
// (mm) lower than any point in the column of radius - tolerance. nullopt proves that no point in that
// narrower column is higher than above + tolerance. Covers every kind of patch, open edges and degenerate
// places.
//
// Branch and bound over the leaves and halves of their nets. The distance in plan to a segment is convex:
// over a hull it is nowhere below its linearisation at one point, which is exact to second order. `tolerance`
// is raised to 1e-12 of the largest coordinate. Thread-safe. Cost: some microseconds, less if nothing is as
// high.
std::optional<SurfacePoint> HighestInColumn(const Surface& surface, const Column& column, double above,
                                            double tolerance);
// Whether there is such a point. True: one was found. False proves that no point in the column of radius -
// tolerance is higher than above + tolerance. Points that were found by earlier calls are tried first; the
// answer does not depend on them.
bool AnyInColumn(const Surface& surface, const Column& column, double above, double tolerance);

}  // namespace patchmill
