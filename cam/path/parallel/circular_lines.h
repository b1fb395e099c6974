// Round lines begin again where they end: what is found along more than one turn, once.
#pragma once

#include <vector>

#include "cam/path/chord/scan_line.h"
#include "cam/path/parallel/line_frame.h"
#include "cam/path/parallel/line_positions.h"

namespace patchmill {

// Where round lines are looked for: `margin` (mm) beyond what is wanted, and a little more than once around,
// from t = 0 on, so that no stretch is cut off where t begins again. `flat`: the flat step, mm.
FrameExtent ExtentOfCircles(const CircularLines& around, double margin, double flat);

// Stretches of a round line that was looked at over `looked` (`once` or more), each once, cut where `looked`
// is no longer than `once`; all of the line is one that begins at 0 and ends at `once`.
std::vector<Interval> RemoveOverlapTurn(const std::vector<Interval>& keep, const Interval& looked,
                                        double once);

// Places in plan along the circle of distance `y` from the frame's place, as many as keep chords within
// `sagitta` (mm) of it. The last one is the first one, to the bit, after a whole turn.
std::vector<Vec2> ArcPlaces(const LineFrame& frame, double y, const Interval& t, double sagitta);

// Runs of a whole turn: those that meet where it begins and ends become one. True where one is all there is
// and closes; its last point is dropped then.
bool CloseAround(double certificate_gap, std::vector<ScanRun>& runs);

}  // namespace patchmill
