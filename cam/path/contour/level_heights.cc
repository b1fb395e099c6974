#include "cam/path/contour/level_heights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <utility>

#include "cam/path/stepover/cheapest_step.h"
#include "cam/path/stepover/step_over.h"
#include "core/base/error_details.h"
#include "core/base/parallel.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

constexpr int kBinsPerStep = 8;       // height bins per flat step-over
constexpr double kMostFlat = 2.0;     // flat step-overs: largest step between full levels
constexpr double kSameHeight = 2e-4;  // mm: lower ends this close together are one
// mm: a level at a flat lies this much above it, so that the flat itself is out of its reach.
constexpr double kAboveFlat = 1e-6;
// Most height bins: a taller part has wider ones.
constexpr double kMostBins = 4e5;
constexpr std::size_t kBetweenPolls = 1024;   // samples between two polls of the run
constexpr double kFewest = 0.9, kMost = 1.1;  // of the gaps that steps require: range that is tried
constexpr double kTooWide = 0.1;              // part of a level's length: cost of a gap wider than `wide`
constexpr double kNothing = 1e-9;             // steps: so small a count means no surface
constexpr int kTrials = 40;                   // at most this many numbers of gaps per rule, and one more

// Which step rules at each height: 0: that of least length (CheapestStep), else this quantile of needs.
constexpr std::array<double, 5> kRules = {0.0, 0.02, 0.1, 0.25, 0.5};

struct Bins {
  double bottom = 0.0, width = 1.0;
  std::vector<double> step;  // mm, needed; infinity: no surface there
  int Of(double z) const {
    return std::clamp(static_cast<int>(std::floor((z - bottom) / width)), 0,
                      static_cast<int>(step.size()) - 1);
  }
  bool Has(std::size_t b) const { return step[b] < kInfinity; }
};

// Returns the heights at which lower ends gather: at least a ball radius of them at one height.
std::vector<double> CommonEnds(std::vector<LowerEnd> ends, double radius, double nearest) {
  std::sort(ends.begin(), ends.end(),
            [](const LowerEnd& a, const LowerEnd& b) { return a.center.z() < b.center.z(); });
  std::vector<double> heights;
  for (std::size_t i = 0; i < ends.size();) {
    std::size_t k = i;
    double length = 0.0;
    while (k < ends.size() && ends[k].center.z() - ends[i].center.z() <= kSameHeight)
      length += ends[k++].length;
    if (length >= radius) {
      heights.push_back(ends[k - 1].center.z() + kAboveFlat);
      i = k;
    } else {
      ++i;
    }
  }
  // A rim that is only nearly horizontal gathers many such heights. The highest serves those just below.
  std::vector<double> apart;
  for (std::size_t k = heights.size(); k-- > 0;) {
    if (apart.empty() || apart.back() - heights[k] >= nearest) apart.push_back(heights[k]);
  }
  return apart;
}

// Returns the steps that rule over surface of these needs, one for each rule.
std::array<double, kRules.size()> Ruling(std::vector<StepNeed>& needs, double smallest, double most) {
  std::array<double, kRules.size()> steps;
  steps.fill(CheapestStep(needs, smallest, most));  // sorts them
  double total = 0.0, passed = 0.0;
  for (const StepNeed& need : needs) total += need.weight;
  std::size_t rule = 1;
  for (const StepNeed& need : needs) {
    passed += need.weight;
    for (; rule < kRules.size() && passed >= kRules[rule] * total; ++rule)
      steps[rule] = std::clamp(need.step, smallest, most);
  }
  return steps;
}

absl::StatusOr<std::array<Bins, kRules.size()>> RulingSteps(const ContourArea& contour_area,
                                                            const HeightParams& params,
                                                            const RunContext& run) {
  Bins bins;
  double lo = kInfinity, hi = -kInfinity;
  for (const ContourSample& s : contour_area.samples) {
    lo = std::min(lo, s.center.z() - s.below);
    hi = std::max(hi, s.center.z() + s.above);
  }
  if (params.base_level) lo = std::min(lo, *params.base_level);
  bins.width = std::max(params.flat / kBinsPerStep, (hi - lo) / kMostBins);
  bins.bottom = lo;
  bins.step.assign(static_cast<std::size_t>((hi - lo) / bins.width) + 1, kInfinity);
  std::vector<std::vector<StepNeed>> needs(bins.step.size());
  for (std::size_t i = 0; i < contour_area.samples.size(); ++i) {
    if (i % kBetweenPolls == 0) PM_RETURN_IF_ERROR(run.Check());
    const ContourSample& s = contour_area.samples[i];
    for (int b = bins.Of(s.center.z() - s.below); b <= bins.Of(s.center.z() + s.above); ++b)
      needs[static_cast<std::size_t>(b)].push_back({s.step, s.width});
  }
  std::array<Bins, kRules.size()> all;
  all.fill(bins);
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, needs.size(), [&](std::size_t b) {
    if (needs[b].empty()) return;
    const auto steps = Ruling(needs[b], params.smallest, kMostFlat * params.flat);
    for (std::size_t k = 0; k < kRules.size(); ++k) all[k].step[b] = steps[k];
  }));
  if (!params.base_level) return all;
  for (Bins& of : all) {  // down to the base level the lowest step continues
    const auto lowest = std::find_if(of.step.begin(), of.step.end(), [](double s) { return s < kInfinity; });
    std::fill(of.step.begin(), lowest, *lowest);
  }
  return all;
}

// Counts the steps that the surface between two heights takes. Each bin takes the worst of its neighbours.
class StepCount {
 public:
  StepCount() = default;
  explicit StepCount(const Bins& bins)
      : bottom_(bins.bottom), width_(bins.width), sum_(bins.step.size() + 1, 0.0) {
    const int n = static_cast<int>(bins.step.size());
    for (int b = 0; b < n; ++b) {
      double step = kInfinity;
      if (bins.Has(static_cast<std::size_t>(b))) {
        for (int k = std::max(0, b - 1); k <= std::min(n - 1, b + 1); ++k)
          step = std::min(step, bins.step[static_cast<std::size_t>(k)]);
      }
      sum_[static_cast<std::size_t>(b) + 1] = sum_[static_cast<std::size_t>(b)] + width_ / step;
    }
  }
  double At(double z) const {
    const double x = std::clamp((z - bottom_) / width_, 0.0, static_cast<double>(sum_.size() - 1));
    const auto b = std::min(static_cast<std::size_t>(x), sum_.size() - 2);
    return sum_[b] + (x - static_cast<double>(b)) * (sum_[b + 1] - sum_[b]);
  }
  // Returns the height at which the count from the bottom reaches `steps`.
  double HeightOf(double steps) const {
    const auto above = std::upper_bound(sum_.begin(), sum_.end(), steps);
    if (above == sum_.end()) return bottom_ + width_ * static_cast<double>(sum_.size() - 1);
    const auto b = static_cast<std::size_t>(above - sum_.begin()) - 1;
    return bottom_ + width_ * (static_cast<double>(b) + (steps - sum_[b]) / (sum_[b + 1] - sum_[b]));
  }

 private:
  double bottom_ = 0.0, width_ = 1.0;
  std::vector<double> sum_ = {0.0, 0.0};
};

struct Stop {
  double z = 0.0;
  bool level = false;  // a level lies exactly here; else the surface merely ends
};

std::vector<Stop> StopsOf(const ContourArea& contour_area, const Bins& bins, const HeightParams& params) {
  std::vector<Stop> stops;
  for (std::size_t b = 0; b < bins.step.size(); ++b) {
    if (bins.Has(b) != (b > 0 && bins.Has(b - 1)))
      stops.push_back({bins.bottom + bins.width * static_cast<double>(b), false});
  }
  if (bins.Has(bins.step.size() - 1))
    stops.push_back({bins.bottom + bins.width * static_cast<double>(bins.step.size()), false});
  for (const double z : CommonEnds(contour_area.lower_ends, params.radius, 0.25 * params.smallest))
    stops.push_back({z, true});
  if (params.base_level) {
    std::erase_if(stops,
                  [&](const Stop& stop) { return stop.z <= *params.base_level + 0.25 * params.smallest; });
    stops.push_back({*params.base_level, true});
  }
  std::sort(stops.begin(), stops.end(), [](const Stop& a, const Stop& b) { return a.z < b.z; });
  return stops;
}

// Returns the heights that divide the steps between two stops into `gaps` equal gaps, with those of levels at
// the stops. An end without a level of its own is half a gap from the nearest level.
std::vector<double> Divided(const StepCount& count, const Stop& low, const Stop& high, int gaps) {
  std::vector<double> heights;
  if (low.level) heights.push_back(low.z);
  const double from = count.At(low.z), steps = count.At(high.z) - from;
  const double step = steps / (gaps + (low.level ? 0.0 : 0.5) + (high.level ? 0.0 : 0.5));
  const int inner = gaps + (low.level && high.level ? -1 : !low.level && !high.level ? 1 : 0);
  for (int k = 0; k < inner; ++k)
    heights.push_back(count.HeightOf(from + ((low.level ? 1.0 : 0.5) + k) * step));
  if (high.level) heights.push_back(high.z);
  return heights;
}

// Estimates the length (mm) of a level that runs within `near` of these places, from the squares of that size
// that it touches. Includes the cost of the ways to its runs.
double PartialLength(std::span<const Vec2> places, double near, double radius) {
  using Square = std::pair<std::int64_t, std::int64_t>;
  std::vector<Square> squares;
  for (const Vec2& q : places) {
    const Square square(std::floor(q.x() / near), std::floor(q.y() / near));
    if (squares.empty() || squares.back() != square) squares.push_back(square);
  }
  std::sort(squares.begin(), squares.end());
  squares.erase(std::unique(squares.begin(), squares.end()), squares.end());
  std::vector<bool> seen(squares.size(), false);
  std::vector<std::size_t> open;
  int runs = 0;
  for (std::size_t first = 0; first < squares.size(); ++first) {
    if (seen[first]) continue;
    ++runs;
    seen[first] = true;
    open.push_back(first);
    while (!open.empty()) {
      const auto [x, y] = squares[open.back()];
      open.pop_back();
      for (std::int64_t dx = -1; dx <= 1; ++dx) {
        auto next = std::lower_bound(squares.begin(), squares.end(), Square(x + dx, y - 1));
        for (; next != squares.end() && *next <= Square(x + dx, y + 1); ++next) {
          const auto k = static_cast<std::size_t>(next - squares.begin());
          if (!seen[k]) open.push_back(k);
          seen[k] = true;
        }
      }
    }
  }
  return 0.25 * kPi * near * static_cast<double>(squares.size()) + runs * kRunCost * radius;
}

// The surface between two stops, with its samples, which rise.
struct BetweenStops {
  Stop low, high;
  std::span<const ContourSample> samples;
};

// Returns the length (mm) of these levels, which rise, with the partial ones between them. Beyond the last
// level before a stop without a level the gap continues as far again as the surface does. The result is
// meaningless once the run is cancelled.
double LengthOf(std::vector<double> heights, const BetweenStops& between, double spacing,
                const HeightParams& params, const RunContext& run) {
  const auto& [low, high, samples] = between;
  if (!high.level) heights.push_back(2.0 * high.z - heights.back());
  if (!low.level) heights.insert(heights.begin(), 2.0 * low.z - heights.front());
  double length = 0.0;
  for (std::size_t k = 0, next = 0; k + 1 < heights.size(); ++k) {
    const bool last = k + 2 == heights.size();
    const double gap = heights[k + 1] - heights[k];
    std::map<int, std::vector<Vec2>> spots;  // by the number of parts that they need
    for (; next < samples.size() && (last || samples[next].center.z() < heights[k + 1]); ++next) {
      const ContourSample& s = samples[next];
      if (next % kBetweenPolls == 0 && run.Cancelled()) return length;
      const double own = s.width * (s.above + s.below) / gap;
      const int parts = PartsOfGap(gap, kWideGap * s.step, params.smallest);
      // No level is added there, but the work that rest passes may have there counts.
      const bool too_wide = parts == 1 && gap > params.wide * s.step && s.step >= params.smallest;
      length += too_wide ? (1.0 + kTooWide) * own : own;
      if (parts > 1) spots[parts].push_back(Xy(s.center));
    }
    for (const auto& [parts, places] : spots)
      length += (parts - 1) * PartialLength(places, ReachOfSpot(spacing, gap / parts), params.radius);
  }
  return length;
}

}  // namespace

absl::Status TooManyLevels(double count) {
  return LimitPassedError({"contour_level_count", static_cast<double>(kMostLevels), count},
                          "contours need more levels; raise the scallop or the tool's radius");
}

absl::StatusOr<LevelPlan> LevelHeights(const ContourArea& contour_area, const HeightParams& params,
                                       const RunContext& run) {
  if (contour_area.samples.empty()) return LevelPlan{};
  PM_ASSIGN_OR_RETURN(const auto ruling, RulingSteps(contour_area, params, run));
  std::array<StepCount, kRules.size()> counts;
  for (std::size_t k = 0; k < kRules.size(); ++k) counts[k] = StepCount(ruling[k]);
  const std::vector<Stop> stops = StopsOf(contour_area, ruling.front(), params);
  std::vector<ContourSample> rising = contour_area.samples;
  std::stable_sort(rising.begin(), rising.end(), [](const ContourSample& a, const ContourSample& b) {
    return a.center.z() < b.center.z();
  });
  const auto from = [&](double z) {
    return std::lower_bound(rising.begin(), rising.end(), z,
                            [](const ContourSample& s, double height) { return s.center.z() < height; });
  };
  // A trial between two stops: the rule that shares out the gaps, and their number.
  struct Trial {
    std::size_t stop = 0, rule = 0;
    int gaps = 0;
  };
  std::vector<Trial> trials;
  std::vector<std::size_t> first;  // first trial of each pair of stops, and the end
  double fewest_levels = 0.0;
  for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
    const Stop &low = stops[i], &high = stops[i + 1];
    first.push_back(trials.size());
    double fewest = kInfinity;
    for (std::size_t rule = 0; rule < kRules.size(); ++rule) {
      const double steps = counts[rule].At(high.z) - counts[rule].At(low.z);
      if (steps <= kNothing) continue;
      const double halves = (low.level ? 0.0 : 0.5) + (high.level ? 0.0 : 0.5);
      const auto gaps = [&](double of_steps) {
        const double least = low.level && high.level ? 1.0 : 0.0;
        return std::clamp(std::ceil(of_steps * steps - halves - 1e-9), least, 2.0 * kMostLevels);
      };
      fewest = std::min(fewest, gaps(kFewest));
      const int few = static_cast<int>(gaps(kFewest)), many = static_cast<int>(gaps(kMost));
      for (int n = few; n <= many; n += 1 + (many - few) / kTrials) trials.push_back({i, rule, n});
    }
    if (fewest < kInfinity) fewest_levels += fewest;
  }
  first.push_back(trials.size());
  if (fewest_levels > static_cast<double>(kMostLevels)) return TooManyLevels(fewest_levels);
  const auto heights_of = [&](const Trial& trial) {
    return Divided(counts[trial.rule], stops[trial.stop], stops[trial.stop + 1], trial.gaps);
  };
  std::vector<double> lengths(trials.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, "contours: levels", trials.size(), [&](std::size_t k) {
    const Stop &low = stops[trials[k].stop], &high = stops[trials[k].stop + 1];
    lengths[k] = LengthOf(heights_of(trials[k]), {low, high, {from(low.z), from(high.z)}},
                          contour_area.spacing, params, run);
  }));
  LevelPlan plan;
  std::vector<double>& heights = plan.heights;
  for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
    if (stops[i].level) heights.push_back(stops[i].z);
    if (first[i] == first[i + 1]) continue;  // no surface to divide
    std::size_t best = first[i];
    for (std::size_t k = first[i] + 1; k < first[i + 1]; ++k) {
      if (lengths[k] < lengths[best] * (1.0 - 1e-9)) best = k;
    }
    plan.length += lengths[best];
    const std::vector<double> chosen = heights_of(trials[best]);
    heights.insert(heights.end(), chosen.begin(), chosen.end());
  }
  if (stops.back().level) heights.push_back(stops.back().z);
  std::sort(heights.begin(), heights.end());
  heights.erase(std::unique(heights.begin(), heights.end()), heights.end());
  return plan;
}

}  // namespace patchmill
