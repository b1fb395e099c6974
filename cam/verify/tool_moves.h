// Divides the motion of a program among its tools, so that each can be judged by its own moves.
#pragma once

#include <vector>

#include "cam/toolpath/toolpath.h"

namespace patchmill {

// The numbers of the tools that move below machine zero, in the order of their first such moves. -1 stands
// for the tool that is in the spindle before the first tool change.
std::vector<int> ToolsOf(const ProgramMotion& motion);

// The moves of one tool. Rules about the start of the program hold for the tool that moves first, rules about
// its end for the one that moves last: for the others they count as kept. Cost O(moves).
ProgramMotion MovesOfTool(const ProgramMotion& motion, int tool);

}  // namespace patchmill
