#include "cam/plan/quickest_angles.h"

#include <algorithm>
#include <numeric>

#include "core/base/status.h"

namespace patchmill {
namespace {

constexpr int kAngles = kQuickestAnglePlans - 1;  // and the mixture

double AngleOf(int k) { return k * kPi / kAngles; }

double Sum(const RegionTimes& times) { return std::accumulate(times.begin(), times.end(), 0.0); }

}  // namespace

RegionTimes TimesOf(const LinkResult& motion, std::size_t regions) {
  RegionTimes times(regions, 0.0);
  double waiting = 0.0;  // ways to the next pass
  std::size_t last = 0;
  const std::vector<Move>& moves = motion.toolpath.moves;
  for (std::size_t i = 1; i < moves.size(); ++i) {
    waiting += EstimatedTime(moves[i], (moves[i].to - moves[i - 1].to).norm());
    const int region = moves[i].region;
    if (region < 0 || static_cast<std::size_t>(region) >= regions) continue;
    last = static_cast<std::size_t>(region);
    times[last] += waiting;
    waiting = 0.0;
  }
  if (regions > 0) times[last] += waiting;
  return times;
}

absl::StatusOr<std::vector<RegionChoice>> QuickestAngles(const RegionMap& map,
                                                         std::vector<RegionChoice> choices,
                                                         const TimePlan& plan) {
  const auto filled = [&](const std::function<double(std::size_t)>& angle) {
    std::vector<RegionChoice> with = choices;
    for (std::size_t id = 0; id < with.size(); ++id) {
      if (with[id].angle_open) with[id].zigzag_angle = angle(id);
      with[id].angle_open = false;
    }
    return with;
  };
  std::vector<int> own(choices.size(), 0);
  std::vector<double> least(choices.size(), kInfinity);
  std::vector<RegionChoice> best;
  double best_time = kInfinity;
  int quickest = 0;
  for (int k = 0; k < kAngles; ++k) {
    std::vector<RegionChoice> with = filled([&](std::size_t) { return AngleOf(k); });
    PM_ASSIGN_OR_RETURN(const RegionTimes times, plan(with));
    for (std::size_t id = 0; id < choices.size(); ++id) {
      if (times[id] >= least[id]) continue;
      least[id] = times[id];
      own[id] = k;
    }
    if (Sum(times) >= best_time) continue;
    best_time = Sum(times);
    best = std::move(with);
    quickest = k;
  }
  std::vector<RegionChoice> mixed = filled([&](std::size_t id) {
    const bool by_contours =
        choices[id].strategy == Strategy::kContour ||
        (choices[id].strategy == Strategy::kAuto && map.regions[id].slope != SlopeClass::kGentle);
    return AngleOf(by_contours ? quickest : own[id]);
  });
  if (mixed == best) return best;
  PM_ASSIGN_OR_RETURN(const RegionTimes times, plan(mixed));
  return Sum(times) < best_time ? mixed : best;
}

}  // namespace patchmill
