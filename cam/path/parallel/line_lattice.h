// The density of zig-zag lines that the surface needs, on a lattice across a band of lines.
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "cam/path/parallel/line_clip.h"
#include "core/base/run_context.h"

namespace patchmill {

// Rows of samples across a band, and the density of lines that they need at the knots.
struct LineLattice {
  double begin = 0.0, spacing = 1.0;         // mm, of the knots
  std::vector<LineShape> rows;               // rising
  std::vector<std::vector<double>> needs;    // mm, by row and sample; 0 where nothing is wanted
  std::vector<std::vector<double>> density;  // 1/mm, by row and knot, also where nothing is wanted
  std::vector<std::vector<char>> wanted;     // by row and knot

  std::size_t knots() const { return density.front().size(); }
  double KnotAt(std::size_t k) const { return begin + spacing * static_cast<double>(k); }
  double RowAt(std::size_t r, std::size_t k) const { return rows[r].At(KnotAt(k)); }
};

// Samples per distance of two knots.
inline constexpr int kSamplesPerKnot = 3;

// Samples a lattice. Its knots lie a ball radius apart along the rows, which run over `range` of t;
// samples lie a third of that apart. The density at a knot is the mean of the samples around it, clamped
// to steps from prober.min_step() to four flat step-overs. The result has no rows if nothing is wanted
// anywhere. Errors: CANCELLED or DEADLINE_EXCEEDED from `run`.
absl::StatusOr<LineLattice> SampleLattice(const LineProber& prober, const Interval& range,
                                          std::vector<LineShape> rows, const RunContext& run);

}  // namespace patchmill
