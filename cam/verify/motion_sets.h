// A program's motion as the sets that are judged: ball centres in the placed frame.
#pragma once

#include <vector>

#include "cam/toolpath/segment_metric.h"
#include "cam/toolpath/toolpath.h"

namespace patchmill {

// Which of a program's moves.
enum class MotionSet {
  kCut,          // feed moves: what removes material
  kSwept,        // all moves below machine zero: what must not gouge
  kSweptRapids,  // the rapids among them
  // Rapids, cut off at the height where nothing stands any more, without those straight up: these only leave
  // through the space that the tool already fills.
  kRapid,
  kDogLegs,  // those of kRapid that drive more than one axis, whole
};

// `offset` is added to tips: program zero plus ball radius upwards. For kRapid and kDogLegs what has its
// centre at or above `clear_z` is left out. A move between machine zero and a place beside it is taken as
// going level at the lower height, which contains whatever the control really does; of a feed move from or to
// machine zero only the lower end is known to be cut.
std::vector<PathSegment> CollectMoves(const ProgramMotion& motion, MotionSet set, const Vec3& offset,
                                      double clear_z = kInfinity);

// Largest of all moves, mm: what the segments may be off.
double ChordError(const ProgramMotion& motion);

}  // namespace patchmill
