// Centre heights: how many exact heights of a ball of diameter 6 one core finds in a second.
#include <vector>

#include <benchmark/benchmark.h>

#include "cam/location/heights.h"
#include "tests/bench/bench_parts.h"
#include "tests/support/random.h"

namespace patchmill::bench {
namespace {

constexpr double kRadius = 3.0;
constexpr double kGrid = 0.25;  // mm

// A grid over the part's box, row by row along x, each query hinted by the contact before, as scan lines do.
// Only places with a surface below count. `height(locator, q, hint)` is the query.
template <class Query>
void MeasureGrid(benchmark::State& state, Part part, const Query& height) {
  const Surface& surface = SurfaceOf(part);
  const Locator locator(surface, kRadius);
  const int nx = 1 + static_cast<int>((surface.box.max.x() - surface.box.min.x()) / kGrid);
  const int ny = 1 + static_cast<int>((surface.box.max.y() - surface.box.min.y()) / kGrid);
  std::int64_t found = 0;
  for (auto _ : state) {
    for (int j = 0; j < ny; ++j) {
      decltype(height(locator, Vec2(), nullptr)) last;
      for (int i = 0; i < nx; ++i) {
        const Vec2 q = Plan(surface.box.min) + kGrid * Vec2(i, j);
        last = height(locator, q, last ? &last->contact : nullptr);
        found += last.has_value();
      }
    }
  }
  state.SetItemsProcessed(found);
  state.counters["defects"] = static_cast<double>(locator.defect_count());
}

void CenterHeight(benchmark::State& state, Part part) {
  MeasureGrid(state, part, [](const Locator& locator, const Vec2& q, const SurfacePoint* hint) {
    return locator.Height(q, hint);
  });
}
BENCHMARK_CAPTURE(CenterHeight, two_hills, Part::kTwoHills)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(CenterHeight, teapot, Part::kTeapot)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(CenterHeight, toroidal_tet, Part::kToroidalTet)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(CenterHeight, bumpy, Part::kBumpy)->Unit(benchmark::kMillisecond);

// The same, each certified to 1e-6 mm: the ratio to CenterHeight is what certification costs.
void CenterHeightCertified(benchmark::State& state, Part part) {
  MeasureGrid(state, part, [](const Locator& locator, const Vec2& q, const SurfacePoint* hint) {
    return locator.CertifiedHeight(q, 1e-6, hint);
  });
}
BENCHMARK_CAPTURE(CenterHeightCertified, two_hills, Part::kTwoHills)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(CenterHeightCertified, teapot, Part::kTeapot)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(CenterHeightCertified, toroidal_tet, Part::kToroidalTet)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(CenterHeightCertified, bumpy, Part::kBumpy)->Unit(benchmark::kMillisecond);

// The same grid in the processor's vector lanes, two rows at a time in tiles of 4 x 2 places;
// `instruction_set` as in Heights(), its name is the label. The ratio to CenterHeight is that of lanes
// to one place after another.
void CenterHeightLanes(benchmark::State& state, Part part) {
  const Surface& surface = SurfaceOf(part);
  const Locator locator(surface, kRadius);
  const auto instruction_set = static_cast<std::size_t>(state.range(0));
  const int nx = 1 + static_cast<int>((surface.box.max.x() - surface.box.min.x()) / kGrid);
  const int ny = 1 + static_cast<int>((surface.box.max.y() - surface.box.min.y()) / kGrid);
  std::vector<Vec2> places;
  std::vector<std::optional<CenterPoint>> heights;
  std::int64_t found = 0;
  for (auto _ : state) {
    for (int j = 0; j + 1 < ny; j += 2) {
      places.clear();
      for (int i = 0; i + 3 < nx; i += 4) {
        for (int k = 0; k < 8; ++k) {
          places.push_back(Plan(surface.box.min) + kGrid * Vec2(i + k % 4, j + k / 4));
        }
      }
      heights.resize(places.size());
      Heights(locator, places, heights, instruction_set);
      for (const auto& h : heights) found += h.has_value();
    }
  }
  state.SetItemsProcessed(found);
  state.SetLabel(InstructionSets()[instruction_set]);
}
void EachInstructionSet(benchmark::internal::Benchmark* rows) {
  rows->Unit(benchmark::kMillisecond);
  for (std::size_t k = 0; k < InstructionSets().size(); ++k) rows->Arg(static_cast<std::int64_t>(k));
}
BENCHMARK_CAPTURE(CenterHeightLanes, two_hills, Part::kTwoHills)->Apply(EachInstructionSet);
BENCHMARK_CAPTURE(CenterHeightLanes, teapot, Part::kTeapot)->Apply(EachInstructionSet);
BENCHMARK_CAPTURE(CenterHeightLanes, toroidal_tet, Part::kToroidalTet)->Apply(EachInstructionSet);
BENCHMARK_CAPTURE(CenterHeightLanes, bumpy, Part::kBumpy)->Apply(EachInstructionSet);

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
