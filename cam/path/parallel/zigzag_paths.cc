#include "cam/path/parallel/zigzag_paths.h"

#include <algorithm>
#include <cmath>

#include "cam/path/chord/chord_thinning.h"
#include "cam/path/edge/sheet_border.h"
#include "cam/path/parallel/circular_lines.h"
#include "cam/path/parallel/line_bends.h"
#include "cam/path/parallel/line_clip.h"
#include "cam/path/parallel/line_gaps.h"
#include "cam/path/parallel/line_positions.h"
#include "cam/path/parallel/split_at_walls.h"
#include "cam/path/stepover/step_over.h"
#include "cam/toolpath/counted_loop.h"
#include "core/base/parallel.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

constexpr double kHighWall = 2.0;            // flat step-overs: lines do not go up and down vertical faces
                                             // higher than this,
constexpr double kWallsToo = Radians(85.0);  // unless the slope window reaches so far that walls are theirs
                                             // to finish

// Returns the line's places in plan from t0 to t1, corners included.
std::vector<Vec2> PlacesOf(const LineFrame& frame, const LineShape& line, const Interval& t) {
  std::vector<Vec2> places;
  for (const double corner : CornersOf(line, t.begin, t.end))
    places.push_back(frame.At(corner, line.At(corner)));
  return places;
}

}  // namespace

absl::StatusOr<std::vector<CutterPath>> ZigzagPaths(const Locator& locator, const ZigzagParams& params,
                                                    const RunContext& run) {
  const Surface& surface = locator.surface();
  const SheetBorder border(surface, params.pass.roll);
  const double flat = CenterStep(locator.radius(), params.pass.scallop, 0.0);
  const FrameExtent extent = params.around ? ExtentOfCircles(*params.around, locator.radius(), flat)
                                           : ExtentOfParallels(surface, params.angle, locator.radius());
  const LineFrame frame =
      params.around ? LineFrame::Around(params.around->center, extent.y.end) : LineFrame::At(params.angle);
  const LineProber prober(locator, border, frame, {params.pass, params.part, params.where}, run);
  const double once = frame.period();
  const Interval once_over = frame.round() ? Interval{extent.t.end - once, extent.t.end} : extent.t;
  const double sagitta = std::min(params.pass.chord_tolerance, kCircleSagitta * flat);
  const double max_bend = frame.round() ? 0.0 : params.max_bend;
  PM_ASSIGN_OR_RETURN(const std::vector<LineBand> bands, LinePositions(prober, extent, params.beside, run));
  std::vector<BentLine> bent;
  std::vector<char> last_of_band;
  for (const LineBand& band : bands) {
    PM_ASSIGN_OR_RETURN(const std::vector<BentLine> more, BendLines(prober, extent.t, band, max_bend, run));
    bent.insert(bent.end(), more.begin(), more.end());
    last_of_band.resize(bent.size(), 0);
    last_of_band.back() = 1;
  }

  std::vector<ClippedLine> lines(bent.size());
  PM_RETURN_IF_ERROR(ParallelFor(run, "zigzag: ends", lines.size(), [&](std::size_t i) {
    lines[i] = ClipLine(prober, bent[i].line, static_cast<double>(i), extent.t);
    lines[i].keep = Common(lines[i].keep, bent[i].where);
  }));
  std::vector<std::vector<ClippedLine>> between(lines.empty() ? 0 : lines.size() - 1);
  PM_RETURN_IF_ERROR(ParallelFor(run, "zigzag: gaps", between.size(), [&](std::size_t i) {
    if (!last_of_band[i]) FillGap(prober, lines[i], lines[i + 1], once_over, between[i]);
  }));

  struct Part {
    const ClippedLine* line;
    int index;
    Interval t;
  };
  std::vector<Part> parts;
  int index = -1;
  double last_rank = -1.0;
  const auto add = [&](const ClippedLine& line, const Interval& looked) {
    if (line.keep.empty()) return;
    if (line.rank != last_rank) ++index;
    last_rank = line.rank;
    const std::vector<Interval> keep = frame.round() ? RemoveOverlapTurn(line.keep, looked, once) : line.keep;
    for (const Interval& t : keep) parts.push_back({&line, index, t});
  };
  for (std::size_t i = 0; i < lines.size(); ++i) {
    add(lines[i], extent.t);
    if (i + 1 == lines.size()) break;
    std::stable_sort(between[i].begin(), between[i].end(),
                     [](const ClippedLine& a, const ClippedLine& b) { return a.rank < b.rank; });
    for (const ClippedLine& line : between[i]) add(line, once_over);
  }

  std::vector<std::vector<ScanRun>> runs(parts.size());
  std::vector<char> closed(parts.size(), 0);
  PM_RETURN_IF_ERROR(CountedFor(run, "zigzag", parts.size(), params.pass.budget, [&](std::size_t i) {
    const Part& part = parts[i];
    const LineShape& line = part.line->line;
    const std::vector<Vec2> places = frame.round() ? ArcPlaces(frame, line.At(part.t.begin), part.t, sagitta)
                                                   : PlacesOf(frame, line, part.t);
    runs[i] = ScanPolyline(locator, places, params.pass, &run);
    if (places.front() == places.back()) closed[i] = CloseAround(CertificateGap(params.pass), runs[i]);
    PathAmount made;
    for (const ScanRun& r : runs[i]) made += AmountOf(r.points);
    return made;
  }));
  std::vector<CutterPath> paths;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (ScanRun& r : runs[i]) {
      if (r.points.size() < 2) continue;
      CutterPath path{.kind = PassKind::kZigzag,
                      .closed = closed[i] != 0,
                      .order_key = parts[i].index,
                      .points = std::move(r.points)};
      if (params.pass.window.max >= kWallsToo) {
        paths.push_back(std::move(path));
        continue;
      }
      for (CutterPath& part : SplitAtWalls(std::move(path), kHighWall * flat))
        paths.push_back(std::move(part));
    }
  }
  return paths;
}

}  // namespace patchmill
