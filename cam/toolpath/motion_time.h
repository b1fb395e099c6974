// The time that a machine takes for a motion, accelerations included.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cam/toolpath/linuxcnc_times.h"
#include "cam/toolpath/machine.h"
#include "cam/toolpath/toolpath.h"
#include "core/base/enum_array.h"

namespace patchmill {

// A straight move as a control sees it.
struct TimedMove {
  Vec3 way = Vec3::Zero();  // mm, from its start to its end
  double feed = 0.0;        // mm/min; ignored for rapids
  bool rapid = false;
};

// Returns the time of each move, s. Every axis keeps its speed and its acceleration, and speed changes evenly
// along the path (trapezoids). A corner between two moves is passed at the speed whose centripetal
// acceleration, on the arc that leaves the corner by the junction deviation, is that of the slower axis; it
// is zero where the path turns back. The first move begins and the last one ends at rest. Cost O(n).
std::vector<double> MoveTimes(std::span<const TimedMove> moves, const Machine& machine);

inline constexpr double kAssumedRapid = 5000.0;  // mm/min, of machines that nobody described

// The time of a move of this length at its feed, s; accelerations are left out.
double EstimatedTime(const Move& move, double length);

// The time of each move of a toolpath, s; the first, at whose end the motion begins, takes none. Without a
// machine, EstimatedTime; else as TimesOn.
std::vector<double> SecondsOf(const Toolpath& toolpath, const std::optional<Machine>& machine,
                              const std::optional<LinuxCncPlanner>& planner = std::nullopt);

// The time of a toolpath, s, by what its moves are for. On an arc the centripetal acceleration is at most
// that of the axes. With a planner, the time is that of LinuxCNC, which takes its tolerance from the program
// and not the junction deviation of the machine.
struct ToolpathTimes {
  double total = 0.0;
  EnumArray<MoveKind, double> of_kind{};
  std::vector<double> of_region;  // of its passes, by the region's id
};
ToolpathTimes TimesOn(const Machine& machine, const Toolpath& toolpath, std::size_t regions,
                      const std::optional<LinuxCncPlanner>& planner = std::nullopt);
// The sums of the times of its moves, which SecondsOf gave.
ToolpathTimes SumsOf(const Toolpath& toolpath, const std::vector<double>& seconds, std::size_t regions);

}  // namespace patchmill
