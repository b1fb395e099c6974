#include "cam/path/zigzag_paths.h"

#include <algorithm>
#include <cmath>

#include "cam/path/line_clip.h"
#include "cam/path/line_positions.h"
#include "cam/path/sheet_border.h"
#include "cam/path/spacing.h"
#include "core/base/parallel.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

// Where the need of either line is below their distance: a line is missing in between.
std::vector<Interval> NarrowSpots(const ClippedLine& a, const ClippedLine& b, const Interval& within,
                                  double flat) {
  const double gap = b.y - a.y;
  std::vector<Interval> spots;
  for (const ClippedLine* line : {&a, &b}) {
    for (const LineProbe& p : line->probes) {
      if (p.wanted && p.need < 0.995 * gap && p.t >= within.begin && p.t <= within.end) {
        spots.push_back({std::max(within.begin, p.t - flat), std::min(within.end, p.t + flat)});
      }
    }
  }
  return Union(std::move(spots), 4.0 * flat);
}

// Halves the gap between two lines where it is too wide, again and again.
void FillGap(const LineProber& prober, const ClippedLine& a, const ClippedLine& b, const Interval& within,
             double min_step, std::vector<ClippedLine>& out) {
  if (0.5 * (b.y - a.y) < min_step || prober.Cancelled()) return;
  for (const Interval& spot : NarrowSpots(a, b, within, prober.flat_step())) {
    const ClippedLine mid = ClipLine(prober, 0.5 * (a.y + b.y), spot);
    FillGap(prober, a, mid, spot, min_step, out);
    out.push_back(mid);
    FillGap(prober, mid, b, spot, min_step, out);
  }
}

}  // namespace

absl::StatusOr<std::vector<CutterPath>> ZigzagPaths(const Locator& locator, const ZigzagParams& params,
                                                    const RunContext& run) {
  const Surface& surface = locator.surface();
  const SheetBorder border(surface, params.roll);
  const LineProber prober(locator, border, LineFrame::At(params.angle), params, params.part, run);
  const double min_step = params.min_step_fraction * prober.flat_step();
  const FrameExtent extent = ExtentInFrame(surface, prober.frame(), locator.radius());
  PM_ASSIGN_OR_RETURN(const std::vector<double> positions, LinePositions(prober, extent, min_step, run));

  std::vector<ClippedLine> lines(positions.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, "zigzag: ends", positions.size(), [&](std::size_t i) {
    lines[i] = ClipLine(prober, positions[i], extent.t);
  }));
  std::vector<std::vector<ClippedLine>> between(lines.empty() ? 0 : lines.size() - 1);
  PM_RETURN_IF_ERROR(ParallelFor(run, "zigzag: gaps", between.size(), [&](std::size_t i) {
    FillGap(prober, lines[i], lines[i + 1], extent.t, min_step, between[i]);
  }));

  struct Part {
    double y;
    int line;
    Interval t;
  };
  std::vector<Part> parts;
  int index = -1;
  double last_y = kInfinity;
  const auto add = [&](const ClippedLine& line) {
    if (line.keep.empty()) return;
    if (line.y != last_y) ++index;
    last_y = line.y;
    for (const Interval& t : line.keep) parts.push_back({line.y, index, t});
  };
  for (std::size_t i = 0; i < lines.size(); ++i) {
    add(lines[i]);
    if (i + 1 == lines.size()) break;
    std::stable_sort(between[i].begin(), between[i].end(),
                     [](const ClippedLine& a, const ClippedLine& b) { return a.y < b.y; });
    for (const ClippedLine& line : between[i]) add(line);
  }

  std::vector<std::vector<ScanRun>> runs(parts.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, "zigzag", parts.size(), [&](std::size_t i) {
    const Part& part = parts[i];
    runs[i] = ScanLine(locator, prober.frame().At(part.t.begin, part.y),
                       prober.frame().At(part.t.end, part.y), params, &run);
  }));
  std::vector<CutterPath> paths;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (ScanRun& r : runs[i]) {
      if (r.points.size() < 2) continue;
      paths.push_back({.kind = PassKind::kZigzag, .line = parts[i].line, .points = std::move(r.points)});
    }
  }
  return paths;
}

}  // namespace patchmill
