#include "cam/path/contour_levels.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "cam/path/cheapest_step.h"
#include "cam/path/spacing.h"

namespace patchmill {
namespace {

constexpr int kBinsPerStep = 8;       // of the flat step
constexpr double kMostFlat = 2.0;     // flat steps; a longer gap has no ground in it
constexpr double kSameHeight = 2e-4;  // mm: lower ends this close together are one
// mm: a level at a flat lies this much above it, so that the flat itself is out of its reach.
constexpr double kAboveFlat = 1e-6;
constexpr double kMostBins = 4e5;

struct Bins {
  double bottom = 0.0, width = 1.0;
  std::vector<double> step;  // needed; infinity: nothing there
  int Of(double z) const {
    return std::clamp(static_cast<int>(std::floor((z - bottom) / width)), 0,
                      static_cast<int>(step.size()) - 1);
  }
};

// Heights at which lower ends gather: at least a ball radius of border at one height.
std::vector<double> CommonEnds(std::vector<LowerEnd> ends, double radius, double nearest) {
  std::sort(ends.begin(), ends.end(), [](const LowerEnd& a, const LowerEnd& b) { return a.z < b.z; });
  std::vector<double> heights;
  for (std::size_t i = 0; i < ends.size();) {
    std::size_t k = i;
    double length = 0.0;
    while (k < ends.size() && ends[k].z - ends[i].z <= kSameHeight) length += ends[k++].length;
    if (length >= radius) {
      heights.push_back(ends[k - 1].z + kAboveFlat);
      i = k;
    } else {
      ++i;
    }
  }
  // A rim that is level only nearly gathers many such heights: the highest serves those closely below.
  std::vector<double> apart;
  for (std::size_t k = heights.size(); k-- > 0;) {
    if (apart.empty() || apart.back() - heights[k] >= nearest) apart.push_back(heights[k]);
  }
  return apart;
}

Bins NeededSteps(const ContourGround& ground, double smallest, double flat) {
  Bins bins;
  double lo = kInfinity, hi = -kInfinity;
  for (const ContourSample& s : ground.samples) {
    lo = std::min(lo, s.center.z() - s.down);
    hi = std::max(hi, s.center.z() + s.up);
  }
  bins.width = std::max(flat / kBinsPerStep, (hi - lo) / kMostBins);
  bins.bottom = lo;
  bins.step.assign(static_cast<std::size_t>((hi - lo) / bins.width) + 1, kInfinity);
  std::vector<std::vector<StepNeed>> needs(bins.step.size());
  for (const ContourSample& s : ground.samples) {
    for (int b = bins.Of(s.center.z() - s.down); b <= bins.Of(s.center.z() + s.up); ++b)
      needs[static_cast<std::size_t>(b)].push_back({s.step, s.width});
  }
  for (std::size_t b = 0; b < needs.size(); ++b) {
    if (!needs[b].empty()) bins.step[b] = CheapestStep(needs[b], smallest, kMostFlat * flat);
  }
  return bins;
}

// How many steps the ground between two heights takes, per bin the worst of its neighbours.
class StepCount {
 public:
  explicit StepCount(const Bins& bins) : bins_(bins), sum_(bins.step.size() + 1, 0.0) {
    const int n = static_cast<int>(bins.step.size());
    for (int b = 0; b < n; ++b) {
      double step = kInfinity;
      if (bins.step[static_cast<std::size_t>(b)] < kInfinity) {
        for (int k = std::max(0, b - 1); k <= std::min(n - 1, b + 1); ++k)
          step = std::min(step, bins.step[static_cast<std::size_t>(k)]);
      }
      sum_[static_cast<std::size_t>(b) + 1] = sum_[static_cast<std::size_t>(b)] + bins.width / step;
    }
  }
  double At(double z) const {
    const double x = std::clamp((z - bins_.bottom) / bins_.width, 0.0, static_cast<double>(sum_.size() - 1));
    const auto b = std::min(static_cast<std::size_t>(x), sum_.size() - 2);
    return sum_[b] + (x - static_cast<double>(b)) * (sum_[b + 1] - sum_[b]);
  }
  // The height at which the count from the bottom reaches `steps`.
  double HeightOf(double steps) const {
    const auto above = std::upper_bound(sum_.begin(), sum_.end(), steps);
    if (above == sum_.end()) return bins_.bottom + bins_.width * static_cast<double>(sum_.size() - 1);
    const auto b = static_cast<std::size_t>(above - sum_.begin()) - 1;
    return bins_.bottom +
           bins_.width * (static_cast<double>(b) + (steps - sum_[b]) / (sum_[b + 1] - sum_[b]));
  }

 private:
  const Bins& bins_;
  std::vector<double> sum_;
};

struct Stop {
  double z = 0.0;
  bool level = false;  // a level lies exactly here; else the ground merely ends
};

// Heights between two stops, evenly in steps and none longer than one; an end without a level of its own is
// half a step from the nearest. Adds `low` itself when it is a level, never `high`.
void Share(const StepCount& count, const Stop& low, const Stop& high, std::vector<double>& heights) {
  if (low.level) heights.push_back(low.z);
  const double from = count.At(low.z), steps = count.At(high.z) - from;
  if (steps <= 0.0) return;
  const double halves = (low.level ? 0.0 : 0.5) + (high.level ? 0.0 : 0.5);
  const int whole = static_cast<int>(std::ceil(steps - halves - 1e-9));
  const int least = low.level && high.level ? 1 : 0;
  const double step = steps / (std::max(whole, least) + halves);
  const int inner = std::max(whole, least) + (low.level && high.level     ? -1
                                              : !low.level && !high.level ? 1
                                                                          : 0);
  for (int k = 0; k < inner; ++k)
    heights.push_back(count.HeightOf(from + ((low.level ? 1.0 : 0.5) + k) * step));
}

}  // namespace

std::vector<PlannedLevel> PlanLevels(const ContourGround& ground, const ContourParams& params,
                                     double radius) {
  if (ground.samples.empty()) return {};
  const double flat = CenterStep(radius, params.scallop, 0.0);
  const double smallest = std::max(1e-6, params.min_step_fraction * flat);
  const Bins bins = NeededSteps(ground, smallest, flat);
  const StepCount count(bins);

  std::vector<Stop> stops;
  for (std::size_t b = 0; b < bins.step.size(); ++b) {
    const bool here = bins.step[b] < kInfinity;
    const bool before = b > 0 && bins.step[b - 1] < kInfinity;
    if (here != before) stops.push_back({bins.bottom + bins.width * static_cast<double>(b), false});
  }
  if (bins.step.back() < kInfinity)
    stops.push_back({bins.bottom + bins.width * static_cast<double>(bins.step.size()), false});
  for (const double z : CommonEnds(ground.lower_ends, radius, 0.25 * smallest)) stops.push_back({z, true});
  std::sort(stops.begin(), stops.end(), [](const Stop& a, const Stop& b) { return a.z < b.z; });
  std::vector<double> heights;
  for (std::size_t i = 0; i + 1 < stops.size(); ++i) Share(count, stops[i], stops[i + 1], heights);
  if (stops.back().level) heights.push_back(stops.back().z);

  const double floor = params.floor_z + radius;
  for (double& z : heights) z = std::max(z, floor);
  std::sort(heights.begin(), heights.end(), std::greater<>());
  heights.erase(std::unique(heights.begin(), heights.end(),
                            [&](double a, double b) { return a - b < 1e-3 * smallest; }),
                heights.end());

  // Samples that need more than they got.
  std::vector<ContourSample> sorted = ground.samples;
  std::stable_sort(sorted.begin(), sorted.end(), [](const ContourSample& a, const ContourSample& b) {
    return a.center.z() > b.center.z();
  });
  std::vector<PlannedLevel> levels;
  std::size_t next = 0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    const double z = heights[i];
    const double gap = i + 1 < heights.size() ? z - heights[i + 1] : i > 0 ? heights[i - 1] - z : flat;
    levels.push_back({z, std::min(gap, kMostFlat * flat), false, {}});
    if (i + 1 == heights.size()) break;
    while (next < sorted.size() && sorted[next].center.z() > z) ++next;
    std::map<int, std::vector<Vec3>> spots;  // by the number of parts that the gap is cut into there
    for (std::size_t k = next; k < sorted.size() && sorted[k].center.z() > heights[i + 1]; ++k) {
      if (gap > kMostFlat * flat) continue;
      const int parts = PartsOfGap(gap, kWideGap * sorted[k].step, smallest);
      if (parts > 1) spots[parts].push_back(sorted[k].center);
    }
    const std::size_t first = levels.size();
    for (const auto& [parts, centers] : spots) {
      for (int k = 1; k < parts; ++k) {
        const double below = gap * k / parts;
        const auto same = std::find_if(levels.begin() + static_cast<std::ptrdiff_t>(first), levels.end(),
                                       [&](const PlannedLevel& l) { return l.z == z - below; });
        if (same == levels.end()) {
          levels.push_back({z - below, gap / parts, true, centers});
        } else {
          same->spots.insert(same->spots.end(), centers.begin(), centers.end());
        }
      }
    }
    std::sort(levels.begin() + static_cast<std::ptrdiff_t>(first), levels.end(),
              [](const PlannedLevel& a, const PlannedLevel& b) { return a.z > b.z; });
  }
  return levels;
}

}  // namespace patchmill
