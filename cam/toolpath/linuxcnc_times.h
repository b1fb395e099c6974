// The time that LinuxCNC takes for a motion: the rules of its trajectory planner [linuxcnctp] that count.
#pragma once

#include <vector>

#include "cam/toolpath/machine.h"
#include "cam/toolpath/toolpath.h"

namespace patchmill {

struct LinuxCncPlanner {
  double tolerance = 0.0;  // mm, P of G64; 0: G61, each move ends at rest
  double step = 1e-4;      // mm, the last decimal of the program
};

// Returns the time of each move, s; the first is where the motion begins and takes none. Lines and arcs are
// driven as the axes allow, an arc with half of the acceleration along the path and sqrt(3) / 2 of it across.
//
// - Between a rapid and a feed, and where the path turns back, the tool comes to rest.
// - A corner is rounded by an arc within the tolerance if both moves lie in one plane. It takes half of a
//   line at most, and of an arc a third at its start and two thirds at its end.
// - At every other corner, however flat, both moves have half of their acceleration, and the second begins
//   while the first ends.
// - The last move has half of its acceleration.
//
// Left out are corners so flat that LinuxCNC passes them unrounded, speeds that a period of the servo limits,
// and the end of the lookahead, 50 moves. Cost O(n).
std::vector<double> LinuxCncTimes(const Machine& machine, const Toolpath& toolpath,
                                  const LinuxCncPlanner& planner);

}  // namespace patchmill
