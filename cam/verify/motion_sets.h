// A program's motion as the sets that are judged: ball centres in the placed frame.
#pragma once

#include <vector>

#include "cam/toolpath/toolpath.h"
#include "cam/verify/segment_metric.h"

namespace patchmill {

struct MotionSets {
  std::vector<PathSegment> cut;    // feed moves: what removes material
  std::vector<PathSegment> swept;  // all moves below machine zero: what must not gouge
  // Rapids, cut off at the height where nothing stands any more, without those straight up: these only leave
  // through the space that the tool already fills.
  std::vector<PathSegment> rapid;
  double chord_error = 0.0;  // mm, largest of all moves: what the segments may be off
};

// `offset` is added to tips: program zero plus ball radius upwards. A rapid's part with its centre at or
// above `clear_z` is left out. A move between machine zero and a place beside it is taken as going level at
// the lower height, which contains whatever the control really does.
MotionSets CollectMotion(const ProgramMotion& motion, const Vec3& offset, double clear_z);

}  // namespace patchmill
