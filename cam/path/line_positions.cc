#include "cam/path/line_positions.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

struct Row {
  double y = 0.0;
  std::vector<double> needs;  // of every wanted sample, sorted; may hold infinity
  bool wanted() const { return !needs.empty(); }
};

Row SampleRow(const LineProber& prober, const Interval& range, double spacing, double y) {
  Row row{y, {}};
  const int count = std::max(1, static_cast<int>(std::ceil((range.end - range.begin) / spacing)));
  for (const LineProbe& p : prober.ProbeRow(range.begin, range.end, count, y)) {
    if (p.wanted) row.needs.push_back(p.need);
  }
  std::sort(row.needs.begin(), row.needs.end());
  return row;
}

// The step with the least length of full plus partial lines: a spot whose need is below the step gets lines
// at step/2, step/4, ...
double CheapestStep(const std::vector<double>& needs, double min_step, double max_step) {
  double best = max_step, best_cost = kInfinity;
  const auto cost = [&](double step) {
    double sum = 0.0;
    for (double need : needs) {
      double lines = 1.0;
      for (double s = step; s > need * (1 + 1e-9) && 0.5 * s >= min_step; s *= 0.5) lines *= 2.0;
      sum += lines;
    }
    return sum / step;
  };
  const auto consider = [&](double step) {
    step = std::clamp(step, min_step, max_step);
    const double c = cost(step);
    if (c < best_cost) {
      best_cost = c;
      best = step;
    }
  };
  for (int k = 0; k <= 16; ++k) consider(needs[(needs.size() - 1) * static_cast<std::size_t>(k) / 16]);
  return best;
}

// The limit of what is wanted between two rows of which only one has something.
double WantedLimit(const LineProber& prober, const Interval& range, double spacing, double with,
                   double without) {
  while (std::abs(with - without) > 1e-3 * prober.flat_step() && !prober.Cancelled()) {
    const double mid = 0.5 * (with + without);
    (SampleRow(prober, range, spacing, mid).wanted() ? with : without) = mid;
  }
  return with;
}

}  // namespace

FrameExtent ExtentInFrame(const Surface& surface, const LineFrame& frame, double margin) {
  FrameExtent e{{kInfinity, -kInfinity}, {kInfinity, -kInfinity}};
  for (const SurfaceLeaf& leaf : surface.leaves) {
    const Eigen::Matrix3d axis = leaf.axis.cast<double>();
    const auto grow = [&](Interval& i, const Vec2& d) {
      const Vec3 direction = Lift(d, 0.0);
      const double mid = leaf.center.dot(direction);
      const double half = (axis.transpose() * direction).cwiseAbs().dot(leaf.half.cast<double>());
      i.begin = std::min(i.begin, mid - half);
      i.end = std::max(i.end, mid + half);
    };
    grow(e.t, frame.along);
    grow(e.y, frame.across);
  }
  e.t = {e.t.begin - margin, e.t.end + margin};
  e.y = {e.y.begin - margin, e.y.end + margin};
  return e;
}

absl::StatusOr<std::vector<double>> LinePositions(const LineProber& prober, const FrameExtent& extent,
                                                  double min_step, const RunContext& run) {
  const double flat = prober.flat_step();
  const double row_step = 1.5 * flat, spacing = 2.0 * flat;
  const double height = extent.y.end - extent.y.begin;
  if (!(height > 0.0)) return std::vector<double>{};
  const auto count = static_cast<std::size_t>(std::ceil(height / row_step)) + 1;
  std::vector<Row> rows(count);
  PM_RETURN_IF_ERROR(ParallelFor(run, "zigzag: positions", count, [&](std::size_t i) {
    const double y = extent.y.begin + height * static_cast<double>(i) / static_cast<double>(count - 1);
    rows[i] = SampleRow(prober, extent.t, spacing, y);
  }));

  std::vector<double> positions;
  for (std::size_t i = 0; i < count; ++i) {
    if (!rows[i].wanted()) continue;
    std::size_t last = i;
    while (last + 1 < count && rows[last + 1].wanted()) ++last;
    PM_RETURN_IF_ERROR(run.Check());
    const double begin = i > 0 ? WantedLimit(prober, extent.t, spacing, rows[i].y, rows[i - 1].y) : rows[i].y;
    const double end = last + 1 < count
                           ? WantedLimit(prober, extent.t, spacing, rows[last].y, rows[last + 1].y)
                           : rows[last].y;
    // Steps of the band, constant between rows; density 1/step is integrated and cut into equal parts.
    std::vector<double> edges{begin}, density;
    const auto max_step = 4.0 * flat;
    std::vector<double> step(last - i + 1);
    for (std::size_t k = i; k <= last; ++k) step[k - i] = CheapestStep(rows[k].needs, min_step, max_step);
    const auto add = [&](double to, double s) {
      edges.push_back(to);
      density.push_back(1.0 / s);
    };
    add(rows[i].y, step.front());
    for (std::size_t k = i; k < last; ++k) add(rows[k + 1].y, std::min(step[k - i], step[k - i + 1]));
    add(end, step.back());
    double total = 0.0;
    for (std::size_t k = 0; k < density.size(); ++k) total += density[k] * (edges[k + 1] - edges[k]);
    const int gaps = std::max(1, static_cast<int>(std::ceil(total - 1e-9)));
    std::size_t k = 0;
    double passed = 0.0;
    for (int g = 0; g <= gaps; ++g) {
      if (g == gaps) {
        positions.push_back(end);
        break;
      }
      const double target = total * g / gaps;
      while (k + 1 < density.size() && passed + density[k] * (edges[k + 1] - edges[k]) < target) {
        passed += density[k] * (edges[k + 1] - edges[k]);
        ++k;
      }
      positions.push_back(edges[k] + (target - passed) / density[k]);
    }
    i = last;
  }
  return positions;
}

}  // namespace patchmill
