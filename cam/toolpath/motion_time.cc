#include "cam/toolpath/motion_time.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "cam/toolpath/trapezoids.h"

namespace patchmill {
namespace {

constexpr double kLeastSagitta = 1e-3;  // mm
constexpr double kShortest = 1e-9;      // mm; a shorter move takes no time

// A straight move with what the axes allow along it.
struct StraightStretch {
  Stretch along;
  Vec3 direction = Vec3::Zero();
};

StraightStretch StretchOf(const TimedMove& move, const Machine& machine) {
  StraightStretch s;
  s.along.length = move.way.norm();
  if (s.along.length < kShortest) return s;
  s.direction = move.way / s.along.length;
  s.along.speed = move.rapid ? kInfinity : move.feed / 60.0;
  s.along.acceleration = kInfinity;
  for (int k = 0; k < 3; ++k) {
    const double share = std::abs(s.direction[k]);
    if (share < 1e-12) continue;
    const MachineAxis& axis = machine.axes[static_cast<std::size_t>(k)];
    s.along.speed = std::min(s.along.speed, (move.rapid ? axis.rapid : axis.feed) / 60.0 / share);
    s.along.acceleration = std::min(s.along.acceleration, axis.acceleration / share);
  }
  return s;
}

// The speed at the corner between two stretches, mm/s.
double CornerSpeed(const StraightStretch& a, const StraightStretch& b, double deviation) {
  const double slower = std::min(a.along.speed, b.along.speed);
  const double cosine = std::clamp(a.direction.dot(b.direction), -1.0, 1.0);
  if (cosine > 1.0 - 1e-12) return slower;
  // Half the inner angle of the corner: 1 for straight on, 0 for a turn back.
  const double half = std::sqrt(0.5 * (1.0 + cosine));
  const double acceleration = std::min(a.along.acceleration, b.along.acceleration);
  return std::min(slower, std::sqrt(acceleration * deviation * half / (1.0 - half)));
}

// The time of each move of a toolpath, s. Chords that are off their arc by the junction deviation are passed,
// corner by corner, at the speed whose centripetal acceleration on the arc is that of the axes.
std::vector<double> JunctionTimes(const Machine& machine, const Toolpath& toolpath) {
  std::vector<TimedMove> moves;
  std::vector<std::size_t> of;  // index of the toolpath's move
  const double sagitta = std::max(machine.junction_deviation, kLeastSagitta);
  for (std::size_t i = 1; i < toolpath.moves.size(); ++i) {
    const Move& move = toolpath.moves[i];
    Vec3 at = toolpath.moves[i - 1].to;
    const auto add = [&](const Vec3& to) {
      moves.push_back({to - at, move.feed, move.kind == MoveKind::kRapid});
      of.push_back(i);
      at = to;
    };
    if (move.arc) {
      for (const Vec3& place : ChordEnds(*move.arc, {at, move.to}, sagitta)) add(place);
    } else {
      add(move.to);
    }
  }
  const std::vector<double> taken = MoveTimes(moves, machine);
  std::vector<double> times(toolpath.moves.size(), 0.0);
  for (std::size_t k = 0; k < taken.size(); ++k) times[of[k]] += taken[k];
  return times;
}

}  // namespace

std::vector<double> MoveTimes(std::span<const TimedMove> moves, const Machine& machine) {
  std::vector<Stretch> stretches;
  std::vector<double> corners;  // speeds at the start of each stretch, and at the end
  std::vector<std::size_t> of;  // index of the move
  StraightStretch before;
  for (std::size_t i = 0; i < moves.size(); ++i) {
    const StraightStretch s = StretchOf(moves[i], machine);
    if (s.along.length < kShortest) continue;
    corners.push_back(stretches.empty() ? 0.0 : CornerSpeed(before, s, machine.junction_deviation));
    stretches.push_back(s.along);
    of.push_back(i);
    before = s;
  }
  corners.push_back(0.0);
  std::vector<double> times(moves.size(), 0.0);
  const std::vector<double> taken = TrapezoidTimes(stretches, std::move(corners));
  for (std::size_t k = 0; k < taken.size(); ++k) times[of[k]] = taken[k];
  return times;
}

double EstimatedTime(const Move& move, double length) {
  return 60.0 * length / (move.kind == MoveKind::kRapid ? kAssumedRapid : move.feed);
}

std::vector<double> SecondsOf(const Toolpath& toolpath, const std::optional<Machine>& machine,
                              const std::optional<LinuxCncPlanner>& planner) {
  if (machine && planner) return LinuxCncTimes(*machine, toolpath, *planner);
  if (machine) return JunctionTimes(*machine, toolpath);
  std::vector<double> times(toolpath.moves.size(), 0.0);
  for (std::size_t i = 1; i < toolpath.moves.size(); ++i) {
    const Move& move = toolpath.moves[i];
    const ArcEnds ends{toolpath.moves[i - 1].to, move.to};
    times[i] = EstimatedTime(move, move.arc ? ArcLength(*move.arc, ends) : (ends.to - ends.from).norm());
  }
  return times;
}

ToolpathTimes TimesOn(const Machine& machine, const Toolpath& toolpath, std::size_t regions,
                      const std::optional<LinuxCncPlanner>& planner) {
  return SumsOf(toolpath, SecondsOf(toolpath, machine, planner), regions);
}

ToolpathTimes SumsOf(const Toolpath& toolpath, const std::vector<double>& seconds, std::size_t regions) {
  ToolpathTimes sums;
  sums.of_region.assign(regions, 0.0);
  for (std::size_t i = 0; i < seconds.size(); ++i) {
    const Move& move = toolpath.moves[i];
    sums.total += seconds[i];
    sums.of_kind[move.kind] += seconds[i];
    if (move.region != kNoRegion && move.region.index() < regions)
      sums.of_region[move.region.index()] += seconds[i];
  }
  return sums;
}

}  // namespace patchmill
