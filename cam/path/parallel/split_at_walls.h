// Splits lines that go up and down vertical faces.
#pragma once

#include <vector>

#include "cam/toolpath/cutter_path.h"

namespace patchmill {

// Returns the parts of a path between its vertical moves longer than `height` (mm), in order, each of two
// points or more; the path itself if it has no such move. A closed path is cut into open parts. Such a move
// finishes nothing that contours do not, plunges beside a wall, and takes as long as the wall is high at
// every line.
std::vector<CutterPath> SplitAtWalls(CutterPath path, double height);

}  // namespace patchmill
