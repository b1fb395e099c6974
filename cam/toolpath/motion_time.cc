#include "cam/toolpath/motion_time.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace patchmill {
namespace {

constexpr double kLeastSagitta = 1e-3;  // mm
constexpr double kShortest = 1e-9;      // mm; a shorter move takes no time

// A move with what the axes allow along it; mm and s.
struct Stretch {
  double length = 0.0;
  Vec3 direction = Vec3::Zero();
  double speed = 0.0, acceleration = 0.0;
};

Stretch StretchOf(const TimedMove& move, const Machine& machine) {
  Stretch s;
  s.length = move.way.norm();
  if (s.length < kShortest) return s;
  s.direction = move.way / s.length;
  s.speed = move.rapid ? kInfinity : move.feed / 60.0;
  s.acceleration = kInfinity;
  for (int k = 0; k < 3; ++k) {
    const double share = std::abs(s.direction[k]);
    if (share < 1e-12) continue;
    const MachineAxis& axis = machine.axes[static_cast<std::size_t>(k)];
    s.speed = std::min(s.speed, (move.rapid ? axis.rapid : axis.feed) / 60.0 / share);
    s.acceleration = std::min(s.acceleration, axis.acceleration / share);
  }
  return s;
}

// The speed at the corner between two stretches, mm/s.
double CornerSpeed(const Stretch& a, const Stretch& b, double deviation) {
  const double slower = std::min(a.speed, b.speed);
  const double cosine = std::clamp(a.direction.dot(b.direction), -1.0, 1.0);
  if (cosine > 1.0 - 1e-12) return slower;
  // Half the inner angle of the corner: 1 for straight on, 0 for a turn back.
  const double half = std::sqrt(0.5 * (1.0 + cosine));
  const double acceleration = std::min(a.acceleration, b.acceleration);
  return std::min(slower, std::sqrt(acceleration * deviation * half / (1.0 - half)));
}

// The time over a stretch that begins and ends with these speeds, which its acceleration allows.
double TimeOver(const Stretch& s, double from, double to) {
  // The speed at the top of a triangle; the stretch's own limit cuts it to a trapezoid.
  const double top = std::min(s.speed, std::sqrt(s.acceleration * s.length + 0.5 * (from * from + to * to)));
  const double ramps = (top - from) + (top - to);
  const double ramps_length = (2.0 * top * top - from * from - to * to) / (2.0 * s.acceleration);
  return ramps / s.acceleration + std::max(0.0, s.length - ramps_length) / top;
}

}  // namespace

std::vector<double> MoveTimes(std::span<const TimedMove> moves, const Machine& machine) {
  std::vector<Stretch> stretches;
  std::vector<std::size_t> of;  // index of the move
  for (std::size_t i = 0; i < moves.size(); ++i) {
    const Stretch s = StretchOf(moves[i], machine);
    if (s.length < kShortest) continue;
    stretches.push_back(s);
    of.push_back(i);
  }
  std::vector<double> times(moves.size(), 0.0);
  if (stretches.empty()) return times;
  // corner[k] is the speed at the start of stretch k; one more for the end.
  std::vector<double> corner(stretches.size() + 1, 0.0);
  for (std::size_t k = 1; k < stretches.size(); ++k)
    corner[k] = CornerSpeed(stretches[k - 1], stretches[k], machine.junction_deviation);
  const auto reachable = [](const Stretch& s, double from) {
    return std::sqrt(from * from + 2.0 * s.acceleration * s.length);
  };
  for (std::size_t k = stretches.size(); k-- > 0;)
    corner[k] = std::min(corner[k], reachable(stretches[k], corner[k + 1]));
  for (std::size_t k = 0; k < stretches.size(); ++k)
    corner[k + 1] = std::min(corner[k + 1], reachable(stretches[k], corner[k]));
  for (std::size_t k = 0; k < stretches.size(); ++k)
    times[of[k]] = TimeOver(stretches[k], corner[k], corner[k + 1]);
  return times;
}

ToolpathTimes TimesOn(const Machine& machine, const Toolpath& toolpath, std::size_t regions) {
  std::vector<TimedMove> moves;
  std::vector<std::size_t> of;  // index of the toolpath's move
  // Chords that are off their arc by the junction deviation are passed, corner by corner, at the speed whose
  // centripetal acceleration on the arc is that of the axes.
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
  const std::vector<double> times = MoveTimes(moves, machine);
  ToolpathTimes sums;
  sums.of_region.assign(regions, 0.0);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const Move& move = toolpath.moves[of[i]];
    sums.total += times[i];
    sums.of_kind[move.kind] += times[i];
    if (move.region != kNoRegion && move.region.index() < regions)
      sums.of_region[move.region.index()] += times[i];
  }
  return sums;
}

}  // namespace patchmill
