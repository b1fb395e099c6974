// Circular lines return to their start. A stretch that is found along more than one turn counts once.
#pragma once

#include <vector>

#include "cam/path/chord/scan_line.h"
#include "cam/path/parallel/line_frame.h"
#include "cam/path/parallel/line_positions.h"

namespace patchmill {

// Returns where circular lines are looked for: `margin` (mm) beyond what is wanted, and a little more than
// one full turn from t = 0 on, so that no stretch is cut off where t begins again. `flat`: the flat
// step-over, mm.
FrameExtent ExtentOfCircles(const CircularLines& around, double margin, double flat);

// Returns each stretch of a circular line once. The line was looked at over `looked`, which is `once` (a full
// turn) or more. Stretches are cut where `looked` is no longer than `once`. If all of the line is kept, the
// result is one stretch from 0 to `once`.
std::vector<Interval> RemoveOverlapTurn(const std::vector<Interval>& keep, const Interval& looked,
                                        double once);

// Returns places in plan along the circle of radius `y` around the frame's centre, as many as keep chords
// within `sagitta` (mm) of the circle. After a whole turn the last place equals the first to the bit.
std::vector<Vec2> ArcPlaces(const LineFrame& frame, double y, const Interval& t, double sagitta);

// Joins the runs of a whole turn that meet where it begins and ends. Returns true if there is only one run
// and it closes; its last point is dropped then.
bool CloseAround(double certificate_gap, std::vector<ScanRun>& runs);

}  // namespace patchmill
