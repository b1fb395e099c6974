// Circular lines return to their start. They are sampled over more than one turn, and what is found twice is
// removed.
#pragma once

#include <vector>

#include "cam/path/chord/scan_line.h"
#include "cam/path/parallel/line_frame.h"
#include "cam/path/parallel/line_positions.h"

namespace patchmill {

// Returns the range of y and t in which circular lines are sampled. y reaches `margin` (mm) beyond the radii
// of `around`. t runs from 0 over a little more than one full turn, so that a stretch across t = 0 is found
// in one piece. `flat`: the flat step-over, mm.
FrameExtent ExtentOfCircles(const CircularLines& around, double margin, double flat);

// Returns the stretches `keep` of a circular line without those that were found twice. The line was sampled
// over the interval `looked` of t; `once` is the length of a full turn in t. If `looked` is no longer than
// `once`, stretches stay cut at its ends. If the whole circle is kept, the result is one stretch from 0 to
// `once`.
std::vector<Interval> RemoveOverlapTurn(const std::vector<Interval>& keep, const Interval& looked,
                                        double once);

// Returns places in plan along the circle of radius `y` around the frame's centre, as many as keep chords
// within `sagitta` (mm) of the circle. After a whole turn the last place equals the first to the bit.
std::vector<Vec2> ArcPlaces(const LineFrame& frame, double y, const Interval& t, double sagitta);

// For the runs of a full turn: joins the last run to the first one if they meet at the start of the turn.
// Returns true if there is only one run and it closes; then its last point, which is its first, is dropped.
bool CloseAround(double certificate_gap, std::vector<ScanRun>& runs);

}  // namespace patchmill
