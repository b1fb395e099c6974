// Centre heights: how many exact heights of a ball of diameter 6 one core finds in a second.
#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "cam/location/simd/heights.h"
#include "tests/bench/bench_parts.h"
#include "tests/bench/over_plain.h"
#include "tests/support/clock.h"
#include "tests/support/instruction_sets.h"
#include "tests/support/random.h"

namespace patchmill::bench {
namespace {

constexpr double kRadius = 3.0;
constexpr double kGrid = 0.25;  // mm

// A grid over the part's box. Only places with a surface below count as found.
struct Grid {
  Vec2 origin;
  int nx, ny;

  explicit Grid(const Surface& surface)
      : origin(Xy(surface.box.min)),
        nx(1 + static_cast<int>((surface.box.max.x() - surface.box.min.x()) / kGrid)),
        ny(1 + static_cast<int>((surface.box.max.y() - surface.box.min.y()) / kGrid)) {}
  Vec2 At(int i, int j) const { return origin + kGrid * Vec2(i, j); }
};

// Row j along x, each query hinted by the contact before, as scan lines do. `height(locator, q, hint)` is the
// query. Returns how many were found.
template <class Query>
std::int64_t OneByOne(const Locator& locator, const Grid& grid, int j, const Query& height) {
  std::int64_t found = 0;
  decltype(height(locator, Vec2(), nullptr)) last;
  for (int i = 0; i < grid.nx; ++i) {
    last = height(locator, grid.At(i, j), last ? &last->contact : nullptr);
    found += last.has_value();
  }
  return found;
}

template <class Query>
void MeasureGrid(benchmark::State& state, Part part, const Query& height) {
  const Surface& surface = SurfaceOf(part);
  const Locator locator(surface, kRadius);
  const Grid grid(surface);
  std::int64_t found = 0;
  for (auto _ : state) {
    for (int j = 0; j < grid.ny; ++j) found += OneByOne(locator, grid, j, height);
  }
  state.SetItemsProcessed(found);
  state.SetLabel(Name(UsedInstructionSet()));
}

std::optional<CenterPoint> Height(const Locator& locator, const Vec2& q, const SurfacePoint* hint) {
  return locator.Height(q, hint);
}

// Rows j and j + 1 as the product asks for them: in vector lanes, in tiles of 4 x 2 places.
class LaneRows {
 public:
  LaneRows(const Locator& locator, const Grid& grid) : locator_(locator), grid_(grid) {}

  std::int64_t Run(int j) {
    places_.clear();
    for (int i = 0; i + 3 < grid_.nx; i += 4) {
      for (int k = 0; k < 8; ++k) places_.push_back(grid_.At(i + k % 4, j + k / 4));
    }
    heights_.resize(places_.size());
    Heights(locator_, places_, heights_);
    return std::count_if(heights_.begin(), heights_.end(), [](const auto& h) { return h.has_value(); });
  }

 private:
  const Locator& locator_;
  const Grid& grid_;
  std::vector<Vec2> places_;
  std::vector<std::optional<CenterPoint>> heights_;
};

// What lanes gain over one place after another on the plain path: places a second of the two, both on every
// eighth pair of rows, in turn; the best of three rounds each, in this thread's processor time.
double OverScalar(const Locator& locator, const Grid& grid, LaneRows& lanes) {
  const auto seconds = [&](const auto& pair) {
    const double start = testing::ClockSeconds(CLOCK_THREAD_CPUTIME_ID);
    std::int64_t found = 0;
    for (int j = 0; j + 1 < grid.ny; j += 16) found += pair(j);
    return (testing::ClockSeconds(CLOCK_THREAD_CPUTIME_ID) - start) / static_cast<double>(found);
  };
  double scalar = kInfinity, in_lanes = kInfinity;
  for (int round = 0; round < 3; ++round) {
    {
      const testing::OnInstructionSet on(InstructionSet::kPlain);
      scalar = std::min(scalar, seconds([&](int j) {
                          return OneByOne(locator, grid, j, Height) + OneByOne(locator, grid, j + 1, Height);
                        }));
    }
    in_lanes = std::min(in_lanes, seconds([&](int j) { return lanes.Run(j); }));
  }
  return scalar / in_lanes;
}

// The grid, as the product finds it, on the instruction set of the label. over_scalar is the ratio to the
// plain scalar path, in the same run.
void CenterHeight(benchmark::State& state, Part part, InstructionSet set) {
  const testing::OnInstructionSet on(set);
  const Surface& surface = SurfaceOf(part);
  const Locator locator(surface, kRadius);
  const Grid grid(surface);
  LaneRows lanes(locator, grid);
  std::int64_t found = 0;
  for (auto _ : state) {
    for (int j = 0; j + 1 < grid.ny; j += 2) found += lanes.Run(j);
  }
  state.SetItemsProcessed(found);
  state.SetLabel(Name(set));
  state.counters["over_scalar"] = OverScalar(locator, grid, lanes);
}

// One place after another.
void CenterHeightScalar(benchmark::State& state, Part part) { MeasureGrid(state, part, Height); }

// The same, each certified to 1e-6 mm: the ratio to CenterHeightScalar is what certification costs.
void CenterHeightCertified(benchmark::State& state, Part part) {
  MeasureGrid(state, part, [](const Locator& locator, const Vec2& q, const SurfacePoint* hint) {
    return locator.CertifiedHeight(q, 1e-6, hint);
  });
}

// CenterHeight/PART is the fastest instruction set, CenterHeight/PART/NAME each of the others.
[[maybe_unused]] const bool registered = [] {
  const std::pair<const char*, Part> parts[] = {{"two_hills", Part::kTwoHills},
                                                {"teapot", Part::kTeapot},
                                                {"toroidal_tet", Part::kToroidalTet},
                                                {"bumpy", Part::kBumpy}};
  const auto add = [](const std::string& name, const auto& row, auto... arguments) {
    benchmark::RegisterBenchmark(name.c_str(), row, arguments...)->Unit(benchmark::kMillisecond);
  };
  for (const auto& [name, part] : parts) {
    const std::string grid = std::string("CenterHeight/") + name;
    for (const InstructionSet set : InstructionSets())
      add(set == InstructionSets().front() ? grid : grid + "/" + Name(set), CenterHeight, part, set);
    add(std::string("CenterHeightScalar/") + name, CenterHeightScalar, part);
    add(std::string("CenterHeightCertified/") + name, CenterHeightCertified, part);
  }
  return true;
}();

// Random places without a hint, each certified to 1e-6 mm.
void CenterHeightRandom(benchmark::State& state, Part part) {
  constexpr double kGap = 1e-6;
  const Surface& surface = SurfaceOf(part);
  const Locator locator(surface, kRadius);
  const auto is_found = [&](testing::Random& random) {
    const double x = random.Uniform(surface.box.min.x(), surface.box.max.x());
    const auto height =
        locator.CertifiedHeight({x, random.Uniform(surface.box.min.y(), surface.box.max.y())}, kGap);
    benchmark::DoNotOptimize(height);
    return height.has_value();
  };
  testing::Random random(1);
  std::int64_t found = 0;
  for (auto _ : state) found += is_found(random);
  state.SetItemsProcessed(found);
  TellInstructionSet(state, 3, [&] {
    testing::Random same(2);
    for (int k = 0; k < 20'000; ++k) is_found(same);
  });
}
BENCHMARK_CAPTURE(CenterHeightRandom, teapot, Part::kTeapot)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace patchmill::bench
