#include "cam/verify/tool_moves.h"

#include <algorithm>
#include <iterator>

namespace patchmill {

namespace {

bool IsBelow(const ProgramMove& move) { return !move.from_above || !move.to_above; }

}  // namespace

std::vector<int> ToolsOf(const ProgramMotion& motion) {
  std::vector<int> tools;
  for (const ProgramMove& move : motion.moves) {
    if (IsBelow(move) && std::find(tools.begin(), tools.end(), move.tool) == tools.end())
      tools.push_back(move.tool);
  }
  return tools;
}

ProgramMotion MovesOfTool(const ProgramMotion& motion, int tool) {
  ProgramMotion own;
  std::copy_if(motion.moves.begin(), motion.moves.end(), std::back_inserter(own.moves),
               [&](const ProgramMove& move) { return move.tool == tool; });
  own.assumptions = motion.assumptions;
  own.tool_number = tool;
  own.has_deletable_lines = motion.has_deletable_lines;
  own.controller_tolerance = motion.controller_tolerance;
  own.rapid_tolerance = motion.rapid_tolerance;
  const auto begin = std::find_if(motion.moves.begin(), motion.moves.end(), IsBelow);
  const auto end = std::find_if(motion.moves.rbegin(), motion.moves.rend(), IsBelow);
  const bool first = begin != motion.moves.end() && begin->tool == tool;
  const bool last = end != motion.moves.rend() && end->tool == tool;
  own.first_motion_is_up = !first || motion.first_motion_is_up;
  own.last_motion_is_up = !last || motion.last_motion_is_up;
  own.ends_with_spindle_off = !last || motion.ends_with_spindle_off;
  own.ends_with_coolant_off = !last || motion.ends_with_coolant_off;
  return own;
}

}  // namespace patchmill
