#include "cam/path/parallel/line_lattice.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

constexpr double kKnotSpacing = 1.0;  // ball radii

// Where nothing is wanted the density is interpolated between the wanted places of the row. Returns whether
// there are any.
bool FillRow(const std::vector<char>& wanted, std::vector<double>& density) {
  std::optional<std::size_t> last;
  for (std::size_t k = 0; k < density.size(); ++k) {
    if (!wanted[k]) continue;
    for (std::size_t i = last ? *last + 1 : 0; i < k; ++i) {
      const double share = last ? static_cast<double>(i - *last) / static_cast<double>(k - *last) : 1.0;
      density[i] = last ? density[*last] + (density[k] - density[*last]) * share : density[k];
    }
    last = k;
  }
  for (std::size_t i = last ? *last + 1 : density.size(); i < density.size(); ++i)
    density[i] = density[*last];
  return last.has_value();
}

}  // namespace

absl::StatusOr<LineLattice> SampleLattice(const LineProber& prober, const Interval& range,
                                          std::vector<LineShape> rows, const RunContext& run) {
  const double flat = prober.flat_step();
  const int stretches =
      std::max(1, static_cast<int>(std::ceil((range.end - range.begin) / (kKnotSpacing * prober.radius()))));
  LineLattice lattice{range.begin, (range.end - range.begin) / stretches, std::move(rows), {}, {}, {}};
  const std::size_t count = lattice.rows.size(), knots = static_cast<std::size_t>(stretches) + 1;
  lattice.needs.resize(count);
  lattice.density.assign(count, std::vector<double>(knots, 0.0));
  lattice.wanted.assign(count, std::vector<char>(knots, 0));
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, count, [&](std::size_t r) {
    const auto row = prober.ProbeRow(range.begin, range.end, stretches * kSamplesPerKnot, lattice.rows[r]);
    // Balls on rims and corners need no neighbour, and do not show how dense lines should be.
    for (const LineProbe& p : row) {
      const bool tells = p.wanted && p.need < kInfinity;
      lattice.needs[r].push_back(tells ? std::clamp(p.need, prober.min_step(), 4.0 * flat) : 0.0);
    }
    for (std::size_t k = 0; k < knots; ++k) {
      double sum = 0.0, weights = 0.0;
      for (int d = 1 - kSamplesPerKnot; d < kSamplesPerKnot; ++d) {
        const int s = static_cast<int>(k) * kSamplesPerKnot + d;
        if (s < 0 || s >= static_cast<int>(row.size())) continue;
        const double need = lattice.needs[r][static_cast<std::size_t>(s)];
        if (need <= 0.0) continue;
        const double weight = kSamplesPerKnot - std::abs(d);
        sum += weight / need;
        weights += weight;
      }
      if (weights > 0.0) lattice.density[r][k] = sum / weights;
      lattice.wanted[r][k] = weights > 0.0;
    }
  }));
  // A row without wanted places takes over the density of the next one below it, or else above it.
  std::optional<std::size_t> filled;
  for (std::size_t r = 0; r < count; ++r) {
    if (FillRow(lattice.wanted[r], lattice.density[r])) {
      if (!filled) std::fill_n(lattice.density.begin(), r, lattice.density[r]);
      filled = r;
    } else if (filled) {
      lattice.density[r] = lattice.density[*filled];
    }
  }
  if (!filled) lattice.rows.clear();  // nothing is wanted anywhere
  return lattice;
}

}  // namespace patchmill
