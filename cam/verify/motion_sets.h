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
  // The parts of rapids below `clear_z`. Rapids straight up are left out, because they only leave through the
  // space that the tool already fills.
  kRapid,
  kDogLegs,  // whole rapids that drive more than one axis and go below `clear_z`
};

// Returns the moves of a set. `offset` is added to tips: the program zero plus the ball radius upwards.
// Nothing stands at centres of height `clear_z` (kRapid and kDogLegs only). A move between machine zero and
// another place is taken as level at the lower height, which contains whatever the control really does. Of a
// feed move from or to machine zero only the lower end counts as cut.
std::vector<PathSegment> CollectMoves(const ProgramMotion& motion, MotionSet set, const Vec3& offset,
                                      double clear_z = kInfinity);

// The largest chord error of all moves, mm: the error of the segments.
double ChordError(const ProgramMotion& motion);

}  // namespace patchmill
