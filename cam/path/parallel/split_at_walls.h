// Lines that go up and down upright walls, in parts.
#pragma once

#include <vector>

#include "cam/toolpath/cutter_path.h"

namespace patchmill {

// The parts of a path between its upright moves longer than `height` (mm), in order, of two points
// or more; the same path where it has none. A closed one is cut into open parts. Such a move finishes nothing
// that contours do not, plunges beside a wall, and takes as long as the wall is high at every line.
std::vector<CutterPath> SplitAtWalls(CutterPath path, double height);

}  // namespace patchmill
