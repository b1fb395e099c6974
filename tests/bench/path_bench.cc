// Passes and regions, on all cores (the clock is the wall's).
#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <benchmark/benchmark.h>

#include "cam/location/heights.h"
#include "cam/path/level_trace.h"
#include "cam/path/scan_line.h"
#include "cam/region/region_map.h"
#include "core/base/parallel.h"
#include "tests/bench/bench_parts.h"

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

// 320 certified scan lines along x; the items are their points. points_per_mm of all lines, fewest_per_mm of
// every twentieth: what the tolerance allows when vertices lie on the curve.
void ZigzagLines(benchmark::State& state, Part part) {
  constexpr std::size_t kLines = 320;
  const Surface& surface = SurfaceOf(part);
  const Locator locator(surface, kRadius);
  PassParams params;
  params.chord_tolerance = 0.01;
  std::int64_t points = 0;
  for (auto _ : state) {
    std::vector<std::int64_t> count(kLines, 0);
    const absl::Status status = ParallelFor(RunContext(), nullptr, kLines, [&](std::size_t k) {
      const double y = surface.box.min.y() +
                       (static_cast<double>(k) + 0.5) / kLines * (surface.box.max.y() - surface.box.min.y());
      for (const ScanRun& run :
           ScanLine(locator, {surface.box.min.x(), y}, {surface.box.max.x(), y}, params)) {
        count[k] += static_cast<std::int64_t>(run.points.size());
      }
    });
    if (!status.ok()) state.SkipWithError(status.ToString().c_str());
    points += std::accumulate(count.begin(), count.end(), std::int64_t{0});
  }
  state.SetItemsProcessed(points);
  const double x0 = surface.box.min.x(), x1 = surface.box.max.x();
  std::vector<double> every;
  for (std::size_t k = 0; k < kLines; k += 20) {
    every.push_back(surface.box.min.y() +
                    (static_cast<double>(k) + 0.5) / kLines * (surface.box.max.y() - surface.box.min.y()));
  }
  state.counters["points_per_mm"] = static_cast<double>(points) / static_cast<double>(state.iterations()) /
                                    (static_cast<double>(kLines) * (x1 - x0));
  state.counters["fewest_per_mm"] = FewestPerMillimetre(locator, every, x0, x1, params.chord_tolerance);
}
BENCHMARK_CAPTURE(ZigzagLines, bumpy, Part::kBumpy)->Unit(benchmark::kMillisecond)->UseRealTime();

// 24 equally spaced levels of h with what they share; the items are the levels.
void ContourLevels(benchmark::State& state, Part part) {
  constexpr std::size_t kLevels = 24;
  const Surface& surface = SurfaceOf(part);
  const Locator locator(surface, kRadius);
  ContourParams params;
  params.chord_tolerance = 0.01;
  params.resolution = 0.1;
  std::size_t loops = 0, ambiguous = 0;
  for (auto _ : state) {
    const RunContext run;
    const LevelContext context(locator, run);
    std::vector<LevelContours> levels(kLevels);
    const absl::Status status = ParallelFor(run, nullptr, kLevels, [&](std::size_t k) {
      const double share = (static_cast<double>(k) + 0.5) / kLevels;
      const double z = kRadius + surface.box.min.z() + share * (surface.box.max.z() - surface.box.min.z());
      levels[k] = TraceLevel(context, z, params, run);
    });
    if (!status.ok()) state.SkipWithError(status.ToString().c_str());
    loops = ambiguous = 0;
    for (const LevelContours& level : levels) {
      loops += level.loops.size();
      ambiguous += static_cast<std::size_t>(level.ambiguous_cells);
    }
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(kLevels) * state.iterations());
  state.counters["loops"] = static_cast<double>(loops);
  state.counters["ambiguous_cells"] = static_cast<double>(ambiguous);
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
