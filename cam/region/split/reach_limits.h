// Finds where balls that touch the surface begin to be free: the limits of reach on segments of a piece.
#pragma once

#include <span>

#include "cam/region/reach/reach.h"
#include "core/lines/zero_field.h"

namespace patchmill {

// At the start of each segment the ball that touches the surface must not be free, at its end it must be.
// Sets limits[k] to the share of segments[k] at which this changes, to `exact` mm on the surface. It follows
// the obstacle to the place at which it ceases to block the ball. Cost: two or three searches for each
// segment.
void ReachLimits(const ReachTest& reach, const Piece& piece, std::span<const ZeroSegment> segments,
                 double exact, std::span<double> limits);

}  // namespace patchmill
