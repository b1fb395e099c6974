#include "cam/path/parallel/line_bends.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "cam/path/parallel/line_gaps.h"
#include "cam/path/parallel/line_lattice.h"
#include "cam/path/stepover/cheapest_step.h"
#include "cam/path/stepover/step_over.h"
#include "core/base/parallel.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

constexpr double kRowStep = 1.5;                // flat step-overs between rows of the lattice
constexpr double kMaxBentRatio = 0.96;          // of the straight lines' length, as the lattice estimates it
constexpr double kMeasured = 0.99;              // of their length, measured with all that fills the gaps
constexpr std::size_t kFew = 64, kLooked = 24;  // gaps of a family: up to kFew all are measured, else kLooked
constexpr double kRun = 0.5;   // ball radii: cost of one more run; most are joined to the next
constexpr double kWall = 2.0;  // flat step-overs between stations: more is a wall, which splits lines

// Returns the density, lines per mm, of the straight lines at y.
double StraightDensity(const LineBand& band, double y) {
  const std::vector<double>& p = band.positions;
  const auto above = std::upper_bound(p.begin() + 1, p.end() - 1, y);
  return 1.0 / (*above - *(above - 1));
}

struct Family {
  std::vector<BentLine> lines;
  std::vector<std::vector<double>> density;  // of lines, at the lattice's rows and knots
};

// Returns how many lines lie below each row at a knot, counted from the band's lower limit.
std::vector<double> CountsAt(const LineLattice& lattice, const std::vector<std::vector<double>>& density,
                             std::size_t k) {
  std::vector<double> counts = {0.0};
  for (std::size_t r = 1; r < lattice.rows.size(); ++r) {
    const double way = lattice.RowAt(r, k) - lattice.RowAt(r - 1, k);
    counts.push_back(counts.back() + 0.5 * way * (density[r - 1][k] + density[r][k]));
  }
  return counts;
}

// Returns the y at a knot at which the count, linear between rows, reaches `count`; beyond the rows the
// limit.
double HeightOf(const LineLattice& lattice, const std::vector<double>& counts, std::size_t k, double count) {
  const auto above = std::upper_bound(counts.begin(), counts.end(), count);
  if (above == counts.begin()) return lattice.RowAt(0, k);
  if (above == counts.end()) return lattice.RowAt(counts.size() - 1, k);
  const auto r = static_cast<std::size_t>(above - counts.begin());
  const double low = lattice.RowAt(r - 1, k), high = lattice.RowAt(r, k);
  return low + (high - low) * (count - counts[r - 1]) / (counts[r] - counts[r - 1]);
}

// Returns the stretches of a line, without those between two knots that lie on one limit.
std::vector<Interval> OffLimits(const LineShape& line, const Interval& limits) {
  std::vector<Interval> where;
  for (std::size_t k = 0; k + 1 < line.y.size(); ++k) {
    const bool lowest = line.y[k] <= limits.begin && line.y[k + 1] <= limits.begin;
    const bool highest = line.y[k] >= limits.end && line.y[k + 1] >= limits.end;
    if (lowest || highest) continue;
    const double from = line.begin + line.spacing * static_cast<double>(k);
    const double to = line.begin + line.spacing * static_cast<double>(k + 1);
    if (!where.empty() && where.back().end == from) {
      where.back().end = to;
    } else {
      where.push_back({from, to});
    }
  }
  return where;
}

// Returns lines as dense as the lattice requires, mixed with straight lines as dense as the densest place of
// their row; `straight` is the share of the latter. Lines bend as little as possible from knot to knot on
// average, and end where they meet the band's limits. Both limits are lines themselves.
Family ShareWay(const LineLattice& lattice, const LineBand& band, double straight) {
  const std::size_t rows = lattice.rows.size(), knots = lattice.knots();
  Family family;
  family.density.assign(rows, std::vector<double>(knots));
  std::vector<std::vector<double>> counts;
  double least = kInfinity, most = -kInfinity;
  std::vector<double> densest;
  for (const std::vector<double>& row : lattice.density)
    densest.push_back(*std::max_element(row.begin(), row.end()));
  for (std::size_t k = 0; k < knots; ++k) {
    for (std::size_t r = 0; r < rows; ++r)
      family.density[r][k] = (1.0 - straight) * lattice.density[r][k] + straight * densest[r];
    counts.push_back(CountsAt(lattice, family.density, k));
    double shift = 0.0;
    if (k > 0) {
      double weights = 0.0;
      for (std::size_t r = 0; r < rows; ++r) {
        const double weight = lattice.wanted[r][k] + lattice.wanted[r][k - 1] + 1e-3;
        shift += weight * (counts[k - 1][r] - counts[k][r]);
        weights += weight;
      }
      shift /= weights;
    }
    for (double& count : counts[k]) count += shift;
    least = std::min(least, counts[k].front());
    most = std::max(most, counts[k].back());
  }
  const std::vector<Interval> everywhere = {{-kInfinity, kInfinity}};
  family.lines.push_back({LineShape::Straight(band.y.begin), everywhere});
  for (double n = std::floor(least) + 1.0; n < most; n += 1.0) {
    LineShape line{lattice.begin, lattice.spacing, {}};
    for (std::size_t k = 0; k < knots; ++k) line.y.push_back(HeightOf(lattice, counts[k], k, n));
    std::vector<Interval> where = OffLimits(line, band.y);
    if (!where.empty()) family.lines.push_back({std::move(line), std::move(where)});
  }
  family.lines.push_back({LineShape::Straight(band.y.end), everywhere});
  return family;
}

// Returns the largest |dy/dt| of the lines next to anything wanted.
double SteepestBend(const LineLattice& lattice, const Family& family) {
  double steepest = 0.0;
  std::vector<std::size_t> row(lattice.knots(), 0);  // the lattice's row next to the line, per knot
  for (const auto& [line, where] : family.lines) {
    if (line.straight()) continue;
    for (std::size_t k = 0; k < row.size(); ++k) {
      while (row[k] + 1 < lattice.rows.size() && std::abs(lattice.RowAt(row[k] + 1, k) - line.y[k]) <
                                                     std::abs(lattice.RowAt(row[k], k) - line.y[k]))
        ++row[k];
    }
    for (std::size_t k = 0; k + 1 < row.size(); ++k) {
      if (!lattice.wanted[row[k]][k] && !lattice.wanted[row[k + 1]][k + 1]) continue;
      steepest = std::max(steepest, std::abs(line.y[k + 1] - line.y[k]) / lattice.spacing);
    }
  }
  return steepest;
}

// Returns the length (mm) of full and partial lines where something is wanted. density(row, sample) is in
// lines per mm of y.
template <class Density>
double LengthOf(const LineLattice& lattice, double min_step, const Density& density) {
  double sum = 0.0;
  for (std::size_t r = 0; r < lattice.rows.size(); ++r) {
    for (std::size_t s = 0; s < lattice.needs[r].size(); ++s) {
      const double need = lattice.needs[r][s];
      if (need <= 0.0) continue;
      const double t = lattice.begin + lattice.spacing * static_cast<double>(s) / kSamplesPerKnot;
      const double below = r > 0 ? lattice.rows[r].At(t) - lattice.rows[r - 1].At(t) : 0.0;
      const double above =
          r + 1 < lattice.rows.size() ? lattice.rows[r + 1].At(t) - lattice.rows[r].At(t) : 0.0;
      const double d = density(r, s);
      sum += d * PartsOfGap(1.0 / d, kWideGap * need, min_step) * 0.5 * (below + above) *
             std::hypot(1.0, lattice.rows[r].SlopeAt(t));
    }
  }
  return sum * lattice.spacing / kSamplesPerKnot;
}

double LengthOf(const LineLattice& lattice, double min_step, const Family& family) {
  return LengthOf(lattice, min_step, [&](std::size_t r, std::size_t s) {
    const std::size_t k = s / kSamplesPerKnot, m = s % kSamplesPerKnot;
    if (m == 0) return family.density[r][k];
    const double share = static_cast<double>(m) / kSamplesPerKnot;
    return family.density[r][k] * (1.0 - share) + family.density[r][k + 1] * share;
  });
}

// Returns the length (mm) along the centres, station by station, with the cost of the runs. Up and down
// vertical faces there are no passes.
double LengthOf(const LineProber& prober, const ClippedLine& line) {
  double length = kRun * prober.radius() * static_cast<double>(line.keep.size());
  auto t = line.keep.begin();
  for (std::size_t i = 1; i < line.probes.size(); ++i) {
    const LineProbe &a = line.probes[i - 1], &b = line.probes[i];
    while (t != line.keep.end() && t->end <= a.t) ++t;
    for (auto k = t; k != line.keep.end() && k->begin < b.t; ++k) {
      const double share = (std::min(b.t, k->end) - std::max(a.t, k->begin)) / (b.t - a.t);
      const double step = (b.center - a.center).norm();
      length += step > kWall * prober.flat_step() ? kRun * prober.radius() : share * step;
    }
  }
  return length;
}

// Returns the length (mm) of these lines with all that fills their gaps, and the cost of the runs. Of more
// than kFew gaps only kLooked are measured, spread evenly.
absl::StatusOr<double> LengthWithGaps(const LineProber& prober, const std::vector<BentLine>& lines,
                                      const Interval& range, const RunContext& run) {
  const std::size_t gaps = lines.size() - 1, looked = gaps <= kFew ? gaps : kLooked;
  const auto clipped = [&](std::size_t i) {
    ClippedLine line = ClipLine(prober, lines[i].line, static_cast<double>(i), range);
    line.keep = Common(line.keep, lines[i].where);
    return line;
  };
  std::vector<double> length(looked, 0.0);
  PM_RETURN_IF_ERROR(ParallelFor(run, nullptr, looked, [&](std::size_t k) {
    const std::size_t i = (2 * k + 1) * gaps / (2 * looked);
    const ClippedLine a = clipped(i), b = clipped(i + 1);
    std::vector<ClippedLine> between;
    FillGap(prober, a, b, range, between);
    length[k] = 0.5 * (LengthOf(prober, a) + LengthOf(prober, b));
    for (const ClippedLine& line : between) length[k] += LengthOf(prober, line);
  }));
  double sum = 0.0;
  for (const double of_gap : length) sum += of_gap;
  return sum * static_cast<double>(gaps) / static_cast<double>(looked);
}

std::vector<LineShape> EveryOther(const std::vector<BentLine>& lines) {
  std::vector<LineShape> rows;
  for (std::size_t i = 0; i + 1 < lines.size(); i += 2) rows.push_back(lines[i].line);
  rows.push_back(lines.back().line);
  return rows;
}

}  // namespace

absl::StatusOr<std::vector<BentLine>> BendLines(const LineProber& prober, const Interval& range,
                                                const LineBand& band, double max_bend,
                                                const RunContext& run) {
  const double min_step = prober.min_step();
  std::vector<BentLine> straight;
  for (const double y : band.positions)
    straight.push_back({LineShape::Straight(y), {{-kInfinity, kInfinity}}});
  if (!(max_bend > 0.0) || straight.size() < 3) return straight;

  const auto count = std::max<std::size_t>(
      3, static_cast<std::size_t>((band.y.end - band.y.begin) / (kRowStep * prober.flat_step())) + 2);
  std::vector<LineShape> rows;
  for (std::size_t r = 0; r < count; ++r) {
    const double share = static_cast<double>(r) / static_cast<double>(count - 1);
    rows.push_back(LineShape::Straight(band.y.begin + (band.y.end - band.y.begin) * share));
  }
  PM_ASSIGN_OR_RETURN(const LineLattice lattice, SampleLattice(prober, range, std::move(rows), run));
  if (lattice.rows.empty()) return straight;

  // Take as little of the straight lines as the bend allows.
  constexpr int kHalvings = 5;
  double low = 0.0, high = 1.0;
  Family family = ShareWay(lattice, band, low);
  if (SteepestBend(lattice, family) <= std::tan(max_bend)) high = low;
  for (int k = 0; k < kHalvings && high > low; ++k) {
    const double share = 0.5 * (low + high);
    Family mixed = ShareWay(lattice, band, share);
    const bool bends_too_far = SteepestBend(lattice, mixed) > std::tan(max_bend);
    (bends_too_far ? low : high) = share;
    if (!bends_too_far) family = std::move(mixed);
  }
  const double least = LengthOf(lattice, min_step, [&](std::size_t r, std::size_t) {
    return StraightDensity(band, lattice.rows[r].y.front());
  });
  std::size_t runs = 0;
  for (const BentLine& line : family.lines) runs += line.where.size();
  const double ways =
      kRunCost * prober.radius() * (static_cast<double>(runs) - static_cast<double>(straight.size()));
  if (high == 1.0 || LengthOf(lattice, min_step, family) + ways > kMaxBentRatio * least) return straight;

  // Sample again along the lines themselves: needs change with the direction.
  PM_ASSIGN_OR_RETURN(const LineLattice bent, SampleLattice(prober, range, EveryOther(family.lines), run));
  if (bent.rows.empty()) return straight;
  Family again = ShareWay(bent, band, high);
  if (SteepestBend(bent, again) <= std::tan(max_bend)) family = std::move(again);
  // Where steps are wide compared with the features of the surface, the needs at the lattice's places say too
  // little of what lies between two lines. So the lengths are measured.
  PM_ASSIGN_OR_RETURN(const double as_bent, LengthWithGaps(prober, family.lines, range, run));
  PM_ASSIGN_OR_RETURN(const double as_straight, LengthWithGaps(prober, straight, range, run));
  return as_bent <= kMeasured * as_straight ? std::move(family.lines) : straight;
}

}  // namespace patchmill
