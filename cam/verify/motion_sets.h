// Selects a program's moves into the sets that are judged, as ball centres in the placed frame
// [verification, section 4].
#pragma once

#include <vector>

#include "cam/toolpath/segment_metric.h"
#include "cam/toolpath/toolpath.h"

namespace patchmill {

// A selection of a program's moves.
enum class MotionSet {
  kCut,          // feed moves: they remove material
  kSwept,        // all moves below machine zero: they must not gouge
  kSweptRapids,  // the rapids among them
  // The parts of rapids below `clear_z`. Rapids straight up are left out: the tool rises through space that
  // it occupied already, ball with upward sweep.
  kRapid,
  kDogLegs,  // rapids that move more than one axis and go below `clear_z`, in full length
};

// Returns the moves of a set, as segments of ball centres. `offset` (mm) is added to the tips of the program:
// the program zero plus the ball radius upwards. `clear_z` (mm, for kRapid and kDogLegs) is a height of the
// centre from which on there is no material. A move between machine zero, whose height is unknown, and
// another place is replaced by a level move at the height of the other place; with its upward sweep it
// contains every way that the control may take. Of a feed move from or to machine zero only the other place
// counts as cut.
std::vector<PathSegment> CollectMoves(const ProgramMotion& motion, MotionSet set, const Vec3& offset,
                                      double clear_z = kInfinity);

// The largest chord error of all moves, mm: the error of the segments.
double ChordError(const ProgramMotion& motion);

}  // namespace patchmill
