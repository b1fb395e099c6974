// Passes and regions, on all cores (the clock is the wall's).
#include <algorithm>
#include <cmath>
#include <vector>

#include <benchmark/benchmark.h>

#include "cam/location/simd/heights.h"
#include "cam/path/chord/scan_line.h"
#include "cam/path/zlevel/level_trace.h"
#include "cam/region/split_regions.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "tests/bench/bench_parts.h"
#include "tests/bench/over_plain.h"

namespace patchmill::bench {
namespace {

constexpr double kRadius = 3.0;

// Of a line given by dense places (t, z): how many of them suffice, so that no place between two lies farther
// than the tolerance from their chord, on either side. Each chord as long as it can be.
std::size_t FewestPoints(const std::vector<Vec2>& line, double tolerance) {
  const auto fits = [&](std::size_t i, std::size_t j) {
    const Vec2 along = (line[j] - line[i]).normalized();
    for (std::size_t k = i + 1; k < j; ++k) {
      if (std::abs(Cross(along, line[k] - line[i])) > tolerance) return false;
    }
    return true;
  };
  std::size_t count = 1;
  for (std::size_t i = 0; i + 1 < line.size(); ++count) {
    std::size_t j = i + 1;
    while (j + 1 < line.size() && fits(i, j + 1)) ++j;
    i = j;
  }
  return count;
}

// The same lines as below, a place every 0.01 mm; points of all lines by their length in plan.
double FewestPerMillimetre(const Locator& locator, const std::vector<double>& y, double x0, double x1,
                           double tolerance) {
  constexpr double kStep = 0.01;
  std::size_t count = 0;
  for (const double at : y) {
    std::vector<Vec2> places;
    for (double x = x0; x <= x1; x += kStep) places.emplace_back(x, at);
    std::vector<std::optional<CenterPoint>> heights(places.size());
    Heights(locator, places, heights);
    std::vector<Vec2> line;
    for (std::size_t k = 0; k < places.size(); ++k) {
      if (heights[k]) line.emplace_back(places[k].x(), heights[k]->z);
    }
    count += FewestPoints(line, tolerance);
  }
  return static_cast<double>(count) / (static_cast<double>(y.size()) * (x1 - x0));
}

constexpr std::size_t kLines = 320;

double LineY(const Surface& surface, std::size_t k) {
  return surface.box.min.y() +
         (static_cast<double>(k) + 0.5) / kLines * (surface.box.max.y() - surface.box.min.y());
}

// What all lines together have. Switches are contact switches that a vertex stands on, solved, with both
// contacts.
struct LineCounts {
  std::int64_t points = 0, switches = 0;

  void operator+=(const LineCounts& other) {
    points += other.points;
    switches += other.switches;
  }
};

LineCounts CountLine(const Locator& locator, std::size_t k, const PassParams& params) {
  const Box3& box = locator.surface().box;
  const double y = LineY(locator.surface(), k);
  LineCounts count;
  for (const ScanRun& run : ScanLine(locator, {box.min.x(), y}, {box.max.x(), y}, params)) {
    count.points += static_cast<std::int64_t>(run.points.size());
    count.switches += std::count_if(run.points.begin(), run.points.end(),
                                    [](const CutterPoint& p) { return p.other_contact.has_value(); });
  }
  return count;
}

absl::StatusOr<LineCounts> CountAllLines(const Locator& locator, const PassParams& params) {
  std::vector<LineCounts> lines(kLines);
  PM_RETURN_IF_ERROR(ParallelFor(RunContext(), nullptr, kLines,
                                 [&](std::size_t k) { lines[k] = CountLine(locator, k, params); }));
  LineCounts all;
  for (const LineCounts& line : lines) all += line;
  return all;
}

// 320 certified scan lines along x; the items are their points. points_per_mm of all lines, fewest_per_mm of
// every twentieth: what the tolerance allows when vertices lie on the curve.
void ZigzagLines(benchmark::State& state, Part part) {
  const Surface& surface = SurfaceOf(part);
  const Locator locator(surface, kRadius);
  PassParams params;
  params.chord_tolerance = 0.01;
  absl::StatusOr<LineCounts> count;
  for (auto _ : state) {
    count = CountAllLines(locator, params);
    if (!count.ok()) return state.SkipWithError(count.status().ToString().c_str());
  }
  state.SetItemsProcessed(count->points * static_cast<std::int64_t>(state.iterations()));
  const double x0 = surface.box.min.x(), x1 = surface.box.max.x();
  std::vector<double> every;
  for (std::size_t k = 0; k < kLines; k += 20) every.push_back(LineY(surface, k));
  state.counters["switches"] = static_cast<double>(count->switches);
  state.counters["points_per_mm"] =
      static_cast<double>(count->points) / (static_cast<double>(kLines) * (x1 - x0));
  state.counters["fewest_per_mm"] = FewestPerMillimetre(locator, every, x0, x1, params.chord_tolerance);
  TellInstructionSet(state, 3, [&] { benchmark::DoNotOptimize(CountAllLines(locator, params)); });
}
BENCHMARK_CAPTURE(ZigzagLines, bumpy, Part::kBumpy)->Unit(benchmark::kMillisecond)->UseRealTime();

// 24 equally spaced levels of h, with what they share.
absl::StatusOr<std::vector<LevelContours>> TraceLevels(const Locator& locator, const ContourParams& params) {
  constexpr std::size_t kLevels = 24;
  const Box3& box = locator.surface().box;
  const RunContext run;
  const LevelContext context(locator, run);
  std::vector<LevelContours> levels(kLevels);
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, kLevels, [&](std::size_t k) {
    const double share = (static_cast<double>(k) + 0.5) / kLevels;
    levels[k] = TraceLevel(context, kRadius + box.min.z() + share * (box.max.z() - box.min.z()), params, run);
  }));
  return levels;
}

// The items are the levels.
void ContourLevels(benchmark::State& state, Part part) {
  const Locator locator(SurfaceOf(part), kRadius);
  ContourParams params;
  params.pass.chord_tolerance = 0.01;
  params.resolution = 0.1;
  absl::StatusOr<std::vector<LevelContours>> levels;
  for (auto _ : state) {
    levels = TraceLevels(locator, params);
    if (!levels.ok()) return state.SkipWithError(levels.status().ToString().c_str());
  }
  std::size_t loops = 0, points = 0, ambiguous = 0;
  for (const LevelContours& level : *levels) {
    loops += level.loops.size();
    for (const auto& loop : level.loops) points += loop.points.size();
    ambiguous += static_cast<std::size_t>(level.ambiguous_cells);
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(levels->size() * state.iterations()));
  state.counters["loops"] = static_cast<double>(loops);
  state.counters["points"] = static_cast<double>(points);
  state.counters["ambiguous_cells"] = static_cast<double>(ambiguous);
  TellInstructionSet(state, 3, [&] { benchmark::DoNotOptimize(TraceLevels(locator, params)); });
}
BENCHMARK_CAPTURE(ContourLevels, bumpy, Part::kBumpy)->Unit(benchmark::kMillisecond)->UseRealTime();

// Regions for a ball of diameter 6, steep above 45 degrees.
void MeasureSplitRegions(benchmark::State& state, Part part) {
  const Surface& surface = SurfaceOf(part);
  RegionParams params;
  params.radius = kRadius;
  std::size_t regions = 0;
  for (auto _ : state) {
    const auto map = SplitRegions(surface, params, RunContext());
    if (!map.ok()) {
      state.SkipWithError(map.status().ToString().c_str());
      break;
    }
    regions = map->regions.size();
  }
  state.counters["regions"] = static_cast<double>(regions);
}
BENCHMARK_CAPTURE(MeasureSplitRegions, teapot, Part::kTeapot)
    ->Name("SplitRegions/teapot")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(MeasureSplitRegions, bumpy, Part::kBumpy)
    ->Name("SplitRegions/bumpy")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace patchmill::bench
