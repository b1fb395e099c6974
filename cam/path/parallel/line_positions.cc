#include "cam/path/parallel/line_positions.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "cam/path/stepover/cheapest_step.h"
#include "cam/path/stepover/step_over.h"
#include "core/base/parallel.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

constexpr double kSteady = 1.03;      // rows whose steps differ by more get a row between them,
constexpr double kNearest = 0.15;     // but none nearer than this many flat step-overs
constexpr double kInsetShare = 0.98;  // of a step: the passes beside a band bend between the sampled places

struct Row {
  double y = 0.0;
  std::vector<StepNeed> needs;  // two for every wanted sample, in order; each for half the way between
                                // samples
  std::vector<char> first;      // for each need: nothing is wanted before it
  double step = 0.0;            // CheapestStep of the needs, if any
  bool wanted() const { return !needs.empty(); }
};

// How rows are sampled: from end to end of `range`, `spacing` (mm) apart. Once `run` is cancelled rows are
// meaningless.
struct RowSampling {
  const LineProber& prober;
  Interval range;
  double spacing = 0.0;
  const RunContext& run;
};

Row SampleRow(const RowSampling& sampling, double y) {
  const auto& [prober, range, spacing, run] = sampling;
  Row row{y, {}, {}, 0.0};
  const int count = std::max(1, static_cast<int>(std::ceil((range.end - range.begin) / spacing)));
  const std::vector<LineProbe> probes =
      prober.ProbeRow(range.begin, range.end, count, LineShape::Straight(y));
  for (std::size_t i = 0; i < probes.size(); ++i) {
    if (!probes[i].wanted) continue;
    // Partial lines begin a flat step-over before the spot that needs them, half way from sample to sample.
    for (const std::size_t k : {i > 0 ? i - 1 : i, i + 1 < probes.size() ? i + 1 : i}) {
      row.first.push_back(k < i && !probes[k].wanted);
      row.needs.push_back({probes[k].wanted ? std::min(probes[i].need, probes[k].need) : probes[i].need});
    }
  }
  return row;
}

// Returns the last row with something wanted between two rows of which only one has something.
Row WantedLimit(const RowSampling& sampling, Row with, double without) {
  const LineProber& prober = sampling.prober;
  while (std::abs(with.y - without) > 1e-3 * prober.flat_step() && !prober.Cancelled()) {
    Row mid = SampleRow(sampling, 0.5 * (with.y + without));
    if (mid.wanted()) {
      with = std::move(mid);
    } else {
      without = mid.y;
    }
  }
  return with;
}

// Adjusts a limit along which circular lines run. If the surface there is not exactly round, the row of the
// limit itself sees little of it and would leave it to rest passes. Returns the last row before the limit
// with nine tenths of the needs of `inside`, if that row is near.
Row AlongLimit(const RowSampling& sampling, const Row& inside, Row limit) {
  const LineProber& prober = sampling.prober;
  const auto sees = [&](const Row& row) { return 10 * row.needs.size() >= 9 * inside.needs.size(); };
  if (!prober.frame().round() || sees(limit)) return limit;
  const double near = kNearest * prober.flat_step(), way = inside.y - limit.y;
  Row along = SampleRow(sampling, limit.y + std::copysign(std::min(near, std::abs(way)), way));
  if (!sees(along)) return limit;
  double without = limit.y;
  while (std::abs(along.y - without) > 1e-3 * prober.flat_step() && !prober.Cancelled()) {
    Row mid = SampleRow(sampling, 0.5 * (along.y + without));
    if (sees(mid)) {
      along = std::move(mid);
    } else {
      without = mid.y;
    }
  }
  // Circles are cut along chords, so the row keeps clear by as much.
  const double chords = std::min(2.0 * kCircleSagitta * prober.flat_step(), std::abs(inside.y - along.y));
  Row clear = SampleRow(sampling, along.y + std::copysign(chords, way));
  return clear.wanted() ? clear : along;
}

// Returns how far (in y) a line at this limit of a band may move inwards without any of its places being
// farther from the passes beside it than its own step. Half way between them lies the surface of the limit.
double InsetOf(const RowSampling& sampling, double y, const SegmentTree& beside) {
  const auto& [prober, range, spacing, run] = sampling;
  const int count = std::max(1, static_cast<int>(std::ceil((range.end - range.begin) / spacing)));
  double inset = kInfinity;
  int hint = -1;
  for (const LineProbe& p : prober.ProbeRow(range.begin, range.end, count, LineShape::Straight(y))) {
    if (!p.wanted || p.need == kInfinity) continue;
    const double step = kInsetShare * 2.0 * p.half_step;
    const SegmentTree::Nearest pass = beside.FindNearest(p.center, step, hint);
    if (pass.segment < 0) return 0.0;
    hint = pass.segment;
    inset = std::min(inset, (step - pass.distance) * p.lateral / p.half_step);
  }
  return inset < kInfinity ? inset : 0.0;
}

// Moves the ends of a band inwards, each at most to the band's middle. Clears the band if neither end moves.
absl::Status MoveInwards(const RowSampling& sampling, const SegmentTree& beside, std::vector<Row>& band) {
  const RunContext& run = sampling.run;
  const double low = band.front().y, high = band.back().y, middle = 0.5 * (low + high);
  const double from = std::min(middle, low + InsetOf(sampling, low, beside));
  const double to = std::max(middle, high - InsetOf(sampling, high, beside));
  PM_RETURN_IF_ERROR(run.Check());
  Row first = SampleRow(sampling, from), last = SampleRow(sampling, to);
  PM_RETURN_IF_ERROR(run.Check());
  if ((from == low && to == high) || !first.wanted() || !last.wanted()) {
    band.clear();
    return absl::OkStatus();
  }
  std::erase_if(band, [&](const Row& row) { return row.y <= from || row.y >= to; });
  band.insert(band.begin(), std::move(first));
  if (to > from) band.push_back(std::move(last));
  return absl::OkStatus();
}

bool Steady(const Row& a, const Row& b) {
  return std::max(a.step, b.step) <= kSteady * std::min(a.step, b.step);
}

// Returns the density, lines per mm, between two rows.
double Density(const Row& a, const Row& b) {
  return Steady(a, b) ? 0.5 / a.step + 0.5 / b.step : 1.0 / std::min(a.step, b.step);
}

// Returns the length of full lines, and of the partial ones between them, where gaps of this width run along
// a row. The unit is half the way between samples. `way` is the cost of one more run.
double LinesAlong(const Row& row, double gap, double way, double least) {
  double length = 0.0;
  int last = 0;
  for (std::size_t i = 0; i < row.needs.size(); ++i) {
    const int parts = PartsOfGap(gap, kWideGap * row.needs[i].step, least);
    length += row.needs[i].weight * parts;
    if (i == 0 || row.first[i]) {
      length += way * parts;
    } else if (parts != last) {
      length += way * (parts - 1);
    }
    last = parts;
  }
  return length;
}

// Number of gaps, and length of full and partial lines in units of half the way between samples.
struct Count {
  int gaps = 1;
  double length = 0.0;
};

// Chooses the number of gaps of a band, at least `total`. The fewest gaps shorten every gap a little; where
// partial lines divide a gap, its parts end up far below what they may be. A few gaps more can need fewer
// parts. The result is meaningless once the prober is cancelled.
Count CheapestCount(const RowSampling& sampling, const std::vector<Row>& band,
                    const std::vector<double>& density, double total) {
  const LineProber& prober = sampling.prober;
  const double way = kRunCost * prober.radius() / (0.5 * sampling.spacing), least = prober.min_step();
  // Numbers of gaps tried beyond the fewest.
  constexpr int kCandidates = 24;
  const int fewest = std::max(1, static_cast<int>(std::ceil(total - 1e-9)));
  const int stride = 1 + fewest / kCandidates;
  const auto length_of = [&](int count, bool full_lines_only) {
    double length = 0.0;
    for (std::size_t i = 0; i < density.size() && !prober.Cancelled(); ++i) {
      const double gap = total / (count * density[i]), lines = 0.5 * (band[i + 1].y - band[i].y) / gap;
      for (const Row* row : {&band[i], &band[i + 1]}) {
        const double stretch = prober.frame().Stretch(row->y);
        length += lines * stretch * LinesAlong(*row, full_lines_only ? 0.0 : gap, way / stretch, least);
      }
    }
    return length;
  };
  int best = fewest;
  double best_length = length_of(best, false);
  const double full_line = length_of(best, true) / best;
  for (int k = 1; k <= kCandidates; ++k) {
    const int count = fewest + k * stride;
    if (prober.Cancelled() || count * full_line >= best_length) break;
    const double length = length_of(count, false);
    if (length < best_length * (1.0 - 1e-9)) {
      best_length = length;
      best = count;
    }
  }
  return {best, best_length};
}

// Sets the step of a row from its needs.
void Judge(Row& row, const LineProber& prober) {
  if (!row.wanted()) return;
  std::vector<StepNeed> sorted = row.needs;
  row.step = CheapestStep(sorted, prober.min_step(), 4.0 * prober.flat_step());
}

// Samples the rows at their y, in parallel.
absl::Status SampleRows(const RowSampling& sampling, const char* what, std::vector<Row>& rows) {
  return ParallelFor(sampling.run, what, rows.size(), [&](std::size_t i) {
    rows[i] = SampleRow(sampling, rows[i].y);
    Judge(rows[i], sampling.prober);
  });
}

struct DividedBand {
  LineBand lines;
  double length = 0.0;  // length of Count
};

// Returns the lines of a band from its first row to its last, both included.
absl::StatusOr<DividedBand> Divide(const RowSampling& sampling, std::vector<Row> band) {
  const double flat = sampling.prober.flat_step();
  Judge(band.front(), sampling.prober);
  Judge(band.back(), sampling.prober);
  for (;;) {
    std::vector<Row> between;
    for (std::size_t k = 0; k + 1 < band.size(); ++k) {
      if (!Steady(band[k], band[k + 1]) && band[k + 1].y - band[k].y >= 2.0 * kNearest * flat)
        between.push_back({0.5 * (band[k].y + band[k + 1].y), {}, {}, 0.0});
    }
    if (between.empty()) break;
    PM_RETURN_IF_ERROR(SampleRows(sampling, nullptr, between));
    std::erase_if(between, [](const Row& row) { return !row.wanted(); });
    if (between.empty()) break;
    band.insert(band.end(), std::make_move_iterator(between.begin()), std::make_move_iterator(between.end()));
    std::sort(band.begin(), band.end(), [](const Row& a, const Row& b) { return a.y < b.y; });
  }
  const double end = band.back().y;
  DividedBand divided{{{band.front().y, end}, {}}, 0.0};
  std::vector<double>& positions = divided.lines.positions;
  // The density 1/step, constant between rows, is integrated and divided into equal parts.
  std::vector<double> edges{band.front().y}, density;
  for (std::size_t k = 0; k + 1 < band.size(); ++k) {
    edges.push_back(band[k + 1].y);
    density.push_back(Density(band[k], band[k + 1]));
  }
  if (density.empty()) {  // one row holds everything
    positions.push_back(end);
    return divided;
  }
  double total = 0.0;
  for (std::size_t k = 0; k < density.size(); ++k) total += density[k] * (edges[k + 1] - edges[k]);
  const Count count = CheapestCount(sampling, band, density, total);
  PM_RETURN_IF_ERROR(sampling.run.Check());
  std::size_t k = 0;
  double passed = 0.0;
  for (int g = 0; g < count.gaps; ++g) {
    const double target = total * g / count.gaps;
    while (k + 1 < density.size() && passed + density[k] * (edges[k + 1] - edges[k]) < target) {
      passed += density[k] * (edges[k + 1] - edges[k]);
      ++k;
    }
    positions.push_back(edges[k] + (target - passed) / density[k]);
  }
  positions.push_back(end);
  divided.length = count.length;
  return divided;
}

}  // namespace

FrameExtent ExtentOfParallels(const Surface& surface, double angle, double margin) {
  const LineFrame frame = LineFrame::At(angle);
  FrameExtent e{{kInfinity, -kInfinity}, {kInfinity, -kInfinity}};
  for (const SurfaceLeaf& leaf : surface.leaves) {
    const Eigen::Matrix3d axis = leaf.axis();
    const auto grow = [&](Interval& i, const Vec2& d) {
      const Vec3 direction = Lift(d, 0.0);
      const double mid = leaf.center().dot(direction);
      const double half = (axis.transpose() * direction).cwiseAbs().dot(leaf.half());
      i.begin = std::min(i.begin, mid - half);
      i.end = std::max(i.end, mid + half);
    };
    grow(e.t, frame.Along(0.0));
    grow(e.y, frame.Across(0.0));
  }
  e.t = {e.t.begin - margin, e.t.end + margin};
  e.y = {e.y.begin - margin, e.y.end + margin};
  return e;
}

absl::StatusOr<std::vector<LineBand>> LinePositions(const LineProber& prober, const FrameExtent& extent,
                                                    const SegmentTree* beside, const RunContext& run) {
  const double flat = prober.flat_step(), row_step = 1.5 * flat;
  const RowSampling sampling{prober, extent.t, 2.0 * flat, run};
  const double height = extent.y.end - extent.y.begin;
  if (!(height > 0.0)) return std::vector<LineBand>{};
  const auto count = static_cast<std::size_t>(std::ceil(height / row_step)) + 1;
  std::vector<Row> rows(count);
  for (std::size_t i = 0; i < count; ++i)
    rows[i].y = extent.y.begin + height * static_cast<double>(i) / static_cast<double>(count - 1);
  PM_RETURN_IF_ERROR(SampleRows(sampling, "zigzag: positions", rows));

  std::vector<LineBand> bands;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!rows[i].wanted()) continue;
    std::size_t last = i;
    while (last + 1 < rows.size() && rows[last + 1].wanted()) ++last;
    PM_RETURN_IF_ERROR(run.Check());
    // Take the rows of a band, from the first to the last place where something is wanted.
    std::vector<Row> band(rows.begin() + static_cast<std::ptrdiff_t>(i),
                          rows.begin() + static_cast<std::ptrdiff_t>(last) + 1);
    const auto limit = [&](const Row& inside, double outside) {
      return AlongLimit(sampling, inside, WantedLimit(sampling, inside, outside));
    };
    if (i > 0) band.insert(band.begin(), limit(rows[i], rows[i - 1].y));
    if (last + 1 < rows.size()) band.push_back(limit(rows[last], rows[last + 1].y));
    PM_RETURN_IF_ERROR(run.Check());
    std::vector<Row> inner;
    if (prober.frame().round() && beside != nullptr && !beside->empty()) {
      inner = band;
      PM_RETURN_IF_ERROR(MoveInwards(sampling, *beside, inner));
    }
    PM_ASSIGN_OR_RETURN(DividedBand lines, Divide(sampling, std::move(band)));
    if (!inner.empty()) {
      PM_ASSIGN_OR_RETURN(DividedBand fewer, Divide(sampling, std::move(inner)));
      if (fewer.lines.positions.size() < lines.lines.positions.size() && fewer.length < lines.length)
        lines = std::move(fewer);
    }
    bands.push_back(std::move(lines.lines));
    i = last;
  }
  return bands;
}

}  // namespace patchmill
