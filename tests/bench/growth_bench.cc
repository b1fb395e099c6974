// How build time, memory and a query grow with the number of patches: waves on a square, cut into more and
// more bicubic Bezier patches of 2 x 2 mm each, every one a patch of the model by itself.
#include <chrono>
#include <cmath>
#include <utility>

#include <benchmark/benchmark.h>

#include "cam/location/locator.h"
#include "tests/bench/bench_parts.h"
#include "tests/support/random.h"

namespace patchmill::bench {
namespace {

constexpr double kRadius = 3.0;
constexpr double kSide = 2.0;  // mm, of a patch

// z = 3 sin(0.31 x) cos(0.27 y) with its derivatives along x, y and both.
struct Wave {
  double z, x, y, xy;
};
Wave WaveAt(double x, double y) {
  const double sx = std::sin(0.31 * x), cx = std::cos(0.31 * x), sy = std::sin(0.27 * y),
               cy = std::cos(0.27 * y);
  return {3.0 * sx * cy, 3.0 * 0.31 * cx * cy, -3.0 * 0.27 * sx * sy, -3.0 * 0.31 * 0.27 * cx * sy};
}

// Equal to the wave and its derivatives at the corners: neighbours share their edges and tangent planes.
BezierPatch WavePatch(double x0, double y0) {
  BezierPatch patch{3, 3, {}, {}};
  patch.points.resize(16);
  const double third = kSide / 3.0;
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      const double corner_x = i < 2 ? x0 : x0 + kSide, corner_y = j < 2 ? y0 : y0 + kSide;
      const double dx = x0 + i * third - corner_x, dy = y0 + j * third - corner_y;
      const Wave w = WaveAt(corner_x, corner_y);
      patch.points[static_cast<std::size_t>(4 * i + j)] =
          Vec3(corner_x + dx, corner_y + dy, w.z + dx * w.x + dy * w.y + dx * dy * w.xy);
    }
  }
  return patch;
}

PatchModel Waves(int side) {
  PatchModel model;
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) model.patches.push_back(Patch{"", WavePatch(kSide * i, kSide * j)});
  }
  return model;
}

double Seconds(std::chrono::steady_clock::time_point since) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
}

// The row's own time is a random query without a hint; what it takes to get there is in the counters:
// s_surface (placing, joining, leaves), s_locator, peak_MB of the process, model and all.
void Growth(benchmark::State& state) {
  const int side = static_cast<int>(std::lround(std::sqrt(static_cast<double>(state.range(0)))));
  ResetPeakMemory();
  PatchModel model = Waves(side);
  auto start = std::chrono::steady_clock::now();
  const auto surface = BuildPlacedSurface(std::move(model), {}, RunContext());
  if (!surface.ok()) return state.SkipWithError(surface.status().ToString().c_str());
  state.counters["s_surface"] = Seconds(start);
  start = std::chrono::steady_clock::now();
  const Locator locator(*surface, kRadius);
  state.counters["s_locator"] = Seconds(start);
  state.counters["peak_MB"] = PeakMemory();
  state.counters["patches"] = static_cast<double>(surface->network.model.patches.size());
  testing::Random random(1);
  for (auto _ : state) {
    const double x = random.Uniform(0.0, kSide * side);
    benchmark::DoNotOptimize(locator.Height({x, random.Uniform(0.0, kSide * side)}));
  }
}
BENCHMARK(Growth)->Arg(100)->Arg(1000)->Arg(10'000)->Arg(99'856)->Iterations(200'000)->Unit(
    benchmark::kNanosecond);

}  // namespace
}  // namespace patchmill::bench
