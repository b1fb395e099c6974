// Where balls that touch the surface begin to be free: the limits of reach on segments of a piece.
#pragma once

#include <span>

#include "cam/region/reach/reach.h"
#include "core/lines/zero_field.h"

namespace patchmill {

// limits[k]: the share of segments[k] (at its start the ball is not free, at its end it is) where that
// changes, in steps of at most `exact` mm on the surface. Follows what is in the way to where it lets go: two
// or three questions a segment.
void ReachLimits(const ReachTest& reach, const Piece& piece, std::span<const ZeroSegment> segments,
                 double exact, std::span<double> limits);

}  // namespace patchmill
