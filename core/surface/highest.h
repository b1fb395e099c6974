// The highest surface point in an upright column: what stands in the way of a cylinder about the tool's axis.
#pragma once

#include <optional>

#include "core/surface/surface.h"

namespace patchmill {

// All that is nearer in plan than `radius` to the segment from a to b (mm; a = b: a round column).
struct Column {
  Vec2 a = Vec2::Zero(), b = Vec2::Zero();
  double radius = 0.0;
};

// A point of the surface in the column and higher than `above` (mm, may be -infinity), at most `tolerance`
// (mm) lower than any in the column that is so much narrower. nullopt proves that nothing in the column of
// radius - tolerance is higher than above + tolerance. Every kind of patch, open edges and degenerate places
// included.
//
// Branch and bound over the leaves and halves of their nets. The distance in plan to a segment is convex:
// over a hull it is nowhere below its linearisation at one point, which is exact to second order. `tolerance`
// is raised to 1e-12 of the largest coordinate. Thread-safe. Cost: some microseconds, less where nothing is
// as high.
std::optional<SurfacePoint> HighestInColumn(const Surface& surface, const Column& column, double above,
                                            double tolerance);
// Whether there is any such point: true with one found, false proves that there is none in the column so much
// narrower that is so much higher than `above`. Points that were found lately are tried first; the answer
// does not depend on them.
bool AnyInColumn(const Surface& surface, const Column& column, double above, double tolerance);

}  // namespace patchmill
