#include "cam/verify/machine_limits.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

namespace patchmill {
namespace {

constexpr double kSlack = 1e-4;      // mm; rounding to four decimals
constexpr double kFeedSlack = 1e-3;  // mm/min

Diagnostic Broken(const char* code, int line, std::string message) {
  Where where;
  if (line > 0) where.line = line;
  return MakeError(code, fmt::format("line {}: {}", line, message), std::move(where));
}

// The places of the tip along one axis, below machine zero.
class AxisWatch {
 public:
  AxisWatch(int axis, const Machine& machine)
      : axis_(axis), machine_(machine), limits_(machine.axes[static_cast<std::size_t>(axis)]) {}

  void AddPlace(const Vec3& tip, int line) {
    if (travel_line_ > 0) return;
    low_ = std::min(low_, tip[axis_]);
    high_ = std::max(high_, tip[axis_]);
    if (high_ - low_ > limits_.travel_max - limits_.travel_min + kSlack) travel_line_ = line;
    if (!machine_.work_zero) return;
    const double at = tip[axis_] + (*machine_.work_zero)[axis_];
    if (at < limits_.travel_min - kSlack || at > limits_.travel_max + kSlack) {
      travel_line_ = line;
      place_ = at;
    }
  }
  void AddFeed(const ProgramMove& move) {
    if (feed_line_ > 0) return;
    const Vec3 way = move.to - move.from;
    const double length = way.norm();
    if (length < 1e-6) return;
    const double feed = move.feed * std::abs(way[axis_]) / length;
    if (feed <= limits_.feed + kFeedSlack) return;
    feed_line_ = move.line;
    feed_ = feed;
  }
  void AddTo(Diagnostics& list) const {
    const char name = "XYZ"[axis_];
    if (travel_line_ > 0 && place_) {
      list.push_back(
          Broken("BEYOND_TRAVEL", travel_line_,
                 fmt::format("{} goes to {:.3f} in machine coordinates; the axis travels from {:.3f} "
                             "to {:.3f} mm",
                             name, *place_, limits_.travel_min, limits_.travel_max)));
    } else if (travel_line_ > 0) {
      list.push_back(Broken("BEYOND_TRAVEL", travel_line_,
                            fmt::format("{} has gone {:.3f} mm from end to end; the axis travels {:.3f} mm",
                                        name, high_ - low_, limits_.travel_max - limits_.travel_min)));
    }
    if (feed_line_ > 0) {
      list.push_back(Broken(
          "FEED_BEYOND_RANGE", feed_line_,
          fmt::format("{} is fed at {:.6g} mm/min; the axis allows {:.6g}", name, feed_, limits_.feed)));
    }
  }

 private:
  int axis_;
  const Machine& machine_;
  const MachineAxis& limits_;
  double low_ = kInfinity, high_ = -kInfinity, feed_ = 0.0;
  int travel_line_ = 0, feed_line_ = 0;
  std::optional<double> place_;
};

}  // namespace

Diagnostics BeyondMachine(const ProgramMotion& motion, const Machine& machine) {
  Diagnostics list;
  for (int axis = 0; axis < 3; ++axis) {
    AxisWatch watch(axis, machine);
    for (const ProgramMove& move : motion.moves) {
      if (!move.from_above && !move.from_anywhere) watch.AddPlace(move.from, move.line);
      if (!move.to_above) watch.AddPlace(move.to, move.line);
      if (move.kind == ProgramMove::Kind::kFeed && !move.from_above && !move.to_above) watch.AddFeed(move);
    }
    watch.AddTo(list);
  }
  const auto out_of_range =
      std::find_if(motion.moves.begin(), motion.moves.end(), [&](const ProgramMove& move) {
        const double speed = move.spindle_speed;
        return move.kind == ProgramMove::Kind::kFeed && speed > 0.0 &&
               (speed < machine.spindle_min || (machine.spindle_max > 0.0 && speed > machine.spindle_max));
      });
  if (out_of_range != motion.moves.end()) {
    list.push_back(
        Broken("SPINDLE_BEYOND_RANGE", out_of_range->line,
               fmt::format("a feed with the spindle at {:g} rpm; the machine allows {:g} to {:g}",
                           out_of_range->spindle_speed, machine.spindle_min, machine.spindle_max)));
  }
  return list;
}

}  // namespace patchmill
