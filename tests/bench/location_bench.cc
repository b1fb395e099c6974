// Centre heights: how many exact heights of a ball of diameter 6 one core finds in a second.
#include <benchmark/benchmark.h>

#include "cam/location/locator.h"
#include "tests/bench/bench_parts.h"
#include "tests/support/random.h"

namespace patchmill::bench {
namespace {

constexpr double kRadius = 3.0;
constexpr double kGrid = 0.25;  // mm

// A grid over the part's box, row by row along x, each query hinted by the contact before, as scan lines do.
// Only places with a surface below count.
void CenterHeight(benchmark::State& state, Part part) {
  const Surface& surface = SurfaceOf(part);
  const Locator locator(surface, kRadius);
  const int nx = 1 + static_cast<int>((surface.box.max.x() - surface.box.min.x()) / kGrid);
  const int ny = 1 + static_cast<int>((surface.box.max.y() - surface.box.min.y()) / kGrid);
  std::int64_t found = 0;
  for (auto _ : state) {
    for (int j = 0; j < ny; ++j) {
      std::optional<CenterPoint> last;
      for (int i = 0; i < nx; ++i) {
        const Vec2 q = Plan(surface.box.min) + kGrid * Vec2(i, j);
        last = locator.Height(q, last ? &last->contact : nullptr);
        found += last.has_value();
      }
    }
  }
  state.SetItemsProcessed(found);
  state.counters["defects"] = static_cast<double>(locator.defect_count());
}
BENCHMARK_CAPTURE(CenterHeight, two_hills, Part::kTwoHills)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(CenterHeight, teapot, Part::kTeapot)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(CenterHeight, toroidal_tet, Part::kToroidalTet)->Unit(benchmark::kMillisecond);

// Random places without a hint, each certified to 1e-6 mm.
void CenterHeightRandom(benchmark::State& state, Part part) {
  constexpr double kGap = 1e-6;
  const Surface& surface = SurfaceOf(part);
  const Locator locator(surface, kRadius);
  testing::Random random(1);
  std::int64_t found = 0;
  for (auto _ : state) {
    const Vec2 q(random.Uniform(surface.box.min.x(), surface.box.max.x()),
                 random.Uniform(surface.box.min.y(), surface.box.max.y()));
    const auto height = locator.CertifiedHeight(q, kGap);
    benchmark::DoNotOptimize(height);
    found += height.has_value();
  }
  state.SetItemsProcessed(found);
  state.counters["defects"] = static_cast<double>(locator.defect_count());
}
BENCHMARK_CAPTURE(CenterHeightRandom, teapot, Part::kTeapot)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace patchmill::bench
