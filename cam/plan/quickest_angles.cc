#include "cam/plan/quickest_angles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "cam/plan/main_directions.h"
#include "cam/toolpath/motion_time.h"
#include "core/base/error_details.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

constexpr int kAngles = 6;
constexpr std::array<double, 3> kTurns = {kPi / 12.0, kPi / 24.0, kPi / 48.0};
constexpr int kAlongBorders = 2;
// All of them and their mixture; of each turn both sides and their mixture; circles and their mixture.
static_assert(kQuickestAnglePlans == kAngles + kAlongBorders + 1 + 3 * static_cast<int>(kTurns.size()) + 2);

// The loop seen from above in strides of a hundredth of its length: its vertices are as exact as a border's
// tolerance, directions from one to the next are not.
void AddStrides(const std::vector<Vec3>& loop, std::vector<Vec2>& strides) {
  double length = 0.0;
  const auto at = [&](std::size_t i) { return Xy(loop[i % loop.size()]); };
  for (std::size_t i = 0; i < loop.size(); ++i) length += (at(i + 1) - at(i)).norm();
  if (loop.empty()) return;
  Vec2 from = at(0);
  for (std::size_t i = 1; i <= loop.size(); ++i) {
    const Vec2 stride = at(i) - from;
    if (i < loop.size() && stride.norm() < 0.01 * length) continue;
    strides.push_back(stride);
    from = at(i);
  }
}

double Sum(const RegionTimes& times) { return std::accumulate(times.begin(), times.end(), 0.0); }

}  // namespace

RegionTimes TimesOf(const LinkResult& motion, std::size_t regions) {
  RegionTimes times(regions, 0.0);
  double waiting = 0.0;  // ways to the next pass
  std::size_t last = 0;
  const std::vector<Move>& moves = motion.toolpath.moves;
  for (std::size_t i = 1; i < moves.size(); ++i) {
    waiting += EstimatedTime(moves[i], (moves[i].to - moves[i - 1].to).norm());
    const RegionId region = moves[i].region;
    if (region == kNoRegion || region.index() >= regions) continue;
    last = region.index();
    times[last] += waiting;
    waiting = 0.0;
  }
  if (regions > 0) times[last] += waiting;
  return times;
}

absl::StatusOr<std::vector<RegionChoice>> QuickestAngles(const RegionMap& map, const RegionChoices& chosen,
                                                         const std::vector<CircularTrial>& trials,
                                                         const TimePlan& plan) {
  const std::vector<RegionChoice>& choices = chosen.choices;
  const auto is_open = [&](std::size_t id) { return chosen.open[id].angle; };
  // How a region's lines run.
  struct Way {
    double angle = 0.0;
    bool round = false;
  };
  struct Tried {
    std::vector<Way> ways;  // of every region
    RegionTimes times;
    double sum = kInfinity;
  };
  const auto with = [&](const std::vector<Way>& ways) {
    std::vector<RegionChoice> filled = choices;
    for (std::size_t id = 0; id < filled.size(); ++id) {
      if (!is_open(id)) continue;
      const bool round = ways[id].round && !trials[id].more.empty();
      if (round) {
        std::vector<CircularComponent>& around = filled[id].around;
        around.insert(around.end(), trials[id].more.begin(), trials[id].more.end());
        std::sort(around.begin(), around.end(), [](const CircularComponent& a, const CircularComponent& b) {
          return a.component < b.component;
        });
      }
      if (round && trials[id].all) {
        filled[id].all_circular = true;
      } else {
        filled[id].zigzag_angle = ways[id].angle;
      }
    }
    return filled;
  };
  const auto attempt = [&](std::vector<Way> ways) -> absl::StatusOr<Tried> {
    absl::StatusOr<RegionTimes> planned = plan(with(ways));
    if (!planned.ok() && LimitPassedOf(planned.status())) planned = RegionTimes(choices.size(), kInfinity);
    PM_ASSIGN_OR_RETURN(RegionTimes times, std::move(planned));
    const double sum = Sum(times);
    return Tried{std::move(ways), std::move(times), sum};
  };
  const auto by_contours = [&](std::size_t id) {
    return choices[id].strategy == Strategy::kContour ||
           (choices[id].strategy == Strategy::kAuto && map.regions[id].slope != SlopeClass::kGentle);
  };
  // Of plans that are tried, the first of the quickest, and what every region likes best.
  const auto best_of = [&](const std::vector<Tried>& plans) -> absl::StatusOr<Tried> {
    const Tried* best = &plans.front();
    for (const Tried& tried : plans) {
      if (tried.sum < best->sum) best = &tried;
    }
    std::vector<Way> mixed = best->ways;
    for (std::size_t id = 0; id < mixed.size(); ++id) {
      if (by_contours(id) && trials[id].more.empty()) continue;
      double least = kInfinity;
      for (const Tried& tried : plans) {
        if (tried.times[id] >= least) continue;
        least = tried.times[id];
        mixed[id] = tried.ways[id];
      }
    }
    const std::vector<RegionChoice> new_mixture = with(mixed);
    for (const Tried& tried : plans) {
      if (with(tried.ways) == new_mixture) return *best;
    }
    PM_ASSIGN_OR_RETURN(Tried mixture, attempt(std::move(mixed)));
    return mixture.sum < best->sum ? std::move(mixture) : *best;
  };

  std::vector<Vec2> border;
  bool any_lines = false, any_circles = false;
  for (std::size_t id = 0; id < map.regions.size(); ++id) {
    const Region& region = map.regions[id];
    any_circles = any_circles || (is_open(id) && !trials[id].more.empty());
    if (!is_open(id) || by_contours(id) || region.kind == RegionKind::kUnreachable) continue;
    any_lines = true;
    for (const std::vector<Vec3>& loop : region.border) AddStrides(loop, border);
  }
  if (std::none_of(chosen.open.begin(), chosen.open.end(), [](const OpenChoice& o) { return o.angle; }))
    return choices;  // every region has its angle, or circles
  std::vector<double> angles;
  for (int k = 0; k < kAngles; ++k) angles.push_back(k * kPi / kAngles);
  for (const double angle : MainDirections(border, kAlongBorders)) {
    if (std::all_of(angles.begin(), angles.end(), [&](double a) { return DirectionsApart(a, angle) > 1e-3; }))
      angles.push_back(angle);
  }
  std::vector<Tried> plans;
  for (const double angle : angles) {
    PM_ASSIGN_OR_RETURN(Tried tried, attempt(std::vector<Way>(choices.size(), {angle, false})));
    plans.push_back(std::move(tried));
  }
  PM_ASSIGN_OR_RETURN(Tried best, best_of(plans));
  for (const double turn : kTurns) {
    if (!any_lines) break;  // none to turn but what is left over
    plans = {best};
    for (const double by : {turn, -turn}) {
      std::vector<Way> turned = best.ways;
      for (Way& way : turned) way.angle = AsDirection(way.angle + by);
      PM_ASSIGN_OR_RETURN(Tried tried, attempt(std::move(turned)));
      plans.push_back(std::move(tried));
    }
    PM_ASSIGN_OR_RETURN(best, best_of(plans));
  }
  if (any_circles) {
    plans = {best};
    std::vector<Way> round = best.ways;
    for (Way& way : round) way.round = true;
    PM_ASSIGN_OR_RETURN(Tried tried, attempt(std::move(round)));
    plans.push_back(std::move(tried));
    PM_ASSIGN_OR_RETURN(best, best_of(plans));
  }
  return with(best.ways);
}

}  // namespace patchmill
