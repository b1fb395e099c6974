// Finds where balls that touch the surface begin to be free: the limits of reach on segments of a piece.
#pragma once

#include <span>

#include "cam/region/reach/reach.h"
#include "core/lines/zero_field.h"

namespace patchmill {

// The ball must not be free at the start of each segment, and free at its end. limits[k] becomes the share of
// segments[k] where this changes, to `exact` mm on the surface. Follows the obstacle to where it lets the
// ball go. Cost: two or three searches per segment.
void ReachLimits(const ReachTest& reach, const Piece& piece, std::span<const ZeroSegment> segments,
                 double exact, std::span<double> limits);

}  // namespace patchmill
