#include "cam/path/zigzag_paths.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "cam/path/chord_thinning.h"
#include "cam/path/line_bends.h"
#include "cam/path/line_clip.h"
#include "cam/path/line_positions.h"
#include "cam/path/once_around.h"
#include "cam/path/sheet_border.h"
#include "cam/path/spacing.h"
#include "cam/path/split_at_walls.h"
#include "core/base/parallel.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

constexpr double kHighWall = 2.0;            // flat steps: lines do not go up and down upright walls of more
constexpr double kWallsToo = Radians(85.0);  // unless walls are theirs to finish
constexpr double kShortest = 4.0;  // flat steps: a stretch of lines shorter than this joins its neighbour

// A stretch of the gap between two lines that has to be cut into so many parts.
struct Stretch {
  Interval t;
  int parts = 2;
};

// What lies in `within` beyond the parts of `less`, both rising and disjoint.
std::vector<Interval> Without(const std::vector<Interval>& within, const std::vector<Interval>& less) {
  std::vector<Interval> rest;
  std::size_t k = 0;
  for (const Interval& w : within) {
    double from = w.begin;
    for (; k < less.size() && less[k].end <= w.end; ++k) {
      if (less[k].begin > from) rest.push_back({from, less[k].begin});
      from = less[k].end;
    }
    if (from < w.end) rest.push_back({from, w.end});
  }
  return rest;
}

// Into how many parts the gap between a place of one line and another line has to be cut. Where one of them
// needs less than the gap, the place half way is asked, which counts most (Simpson's rule: the surface bulges
// between two places by its curvature in the mean, with weights that rise towards the middle).
int PartsTowards(const LineProber& prober, const LineProbe& p, const ClippedLine& line,
                 const ClippedLine& other, double min_step) {
  const double y = line.line.At(p.t), across = other.line.At(p.t) - y;
  const auto parts = [&](double need) { return PartsOfGap(std::abs(across), kWideGap * need, min_step); };
  const auto tells = [](const LineProbe& q) { return q.wanted && q.need < kInfinity; };
  const std::vector<LineProbe>& probes = other.probes;
  auto at = std::lower_bound(probes.begin(), probes.end(), p.t,
                             [](const LineProbe& q, double t) { return q.t < t; });
  if (at == probes.end() || (at != probes.begin() && p.t - std::prev(at)->t < at->t - p.t)) --at;
  if (!tells(p) || !tells(*at)) return parts(p.need);
  if (parts(std::min(p.need, at->need)) == 1) return 1;
  const double ends = 1.0 / p.need + 1.0 / at->need;
  const double slope = 0.5 * (line.line.SlopeAt(p.t) + other.line.SlopeAt(p.t));
  const LineProbe middle = prober.Probe(p.t, y + 0.5 * across, slope, p.contact ? &*p.contact : nullptr);
  return parts(tells(middle) ? 6.0 / (ends + 4.0 / middle.need) : 2.0 / ends);
}

// Where two lines need a neighbour nearer than the other one, and into how many parts that cuts their gap.
std::vector<Stretch> NarrowStretches(const LineProber& prober, const ClippedLine& a, const ClippedLine& b,
                                     const Interval& within, double min_step) {
  const double flat = prober.flat_step();
  std::map<int, std::vector<Interval>> spots;
  for (const ClippedLine* line : {&a, &b}) {
    for (const LineProbe& p : line->probes) {
      if (!p.wanted || p.t < within.begin || p.t > within.end) continue;
      const int parts = PartsTowards(prober, p, *line, line == &a ? b : a, min_step);
      if (parts > 1)
        spots[parts].push_back({std::max(within.begin, p.t - flat), std::min(within.end, p.t + flat)});
    }
  }
  // Nested, from the fewest parts up: what needs more lies within what needs fewer, and takes its ends over
  // where they are near.
  std::vector<Stretch> stretches;
  std::vector<Interval> all = {within};
  for (auto from = spots.begin(); from != spots.end(); ++from) {
    std::vector<Interval> here;
    for (auto more = from; more != spots.end(); ++more)
      here.insert(here.end(), more->second.begin(), more->second.end());
    here = Union(std::move(here), kShortest * flat);
    if (from != spots.begin()) {
      for (Interval& i : here) {
        const auto whole =
            std::find_if(all.begin(), all.end(), [&](const Interval& w) { return i.end <= w.end; });
        if (i.begin - whole->begin < kShortest * flat) i.begin = whole->begin;
        if (whole->end - i.end < kShortest * flat) i.end = whole->end;
      }
      for (const Interval& t : Without(all, here)) stretches.push_back({t, std::prev(from)->first});
    }
    all = std::move(here);
  }
  if (!spots.empty()) {
    for (const Interval& t : all) stretches.push_back({t, spots.rbegin()->first});
  }
  return stretches;
}

// Cuts the gap between two lines into as many parts as it needs, stretch by stretch; the new lines may find
// that they need more.
void FillGap(const LineProber& prober, const ClippedLine& a, const ClippedLine& b, const Interval& within,
             double min_step, std::vector<ClippedLine>& out) {
  if (prober.Cancelled()) return;
  for (const Stretch& stretch : NarrowStretches(prober, a, b, within, min_step)) {
    ClippedLine last = a;
    for (int k = 1; k < stretch.parts; ++k) {
      const double share = static_cast<double>(k) / stretch.parts;
      ClippedLine line =
          ClipLine(prober, Between(a.line, b.line, share), a.rank + (b.rank - a.rank) * share, stretch.t);
      FillGap(prober, last, line, stretch.t, min_step, out);
      out.push_back(line);
      last = std::move(line);
    }
    FillGap(prober, last, b, stretch.t, min_step, out);
  }
}

// The line's places in plan from t0 to t1, corners included.
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
  const SheetBorder border(surface, params.roll);
  const double flat = CenterStep(locator.radius(), params.scallop, 0.0);
  const FrameExtent extent = params.around ? ExtentOfRound(*params.around, locator.radius(), flat)
                                           : ExtentOfParallels(surface, params.angle, locator.radius());
  const LineFrame frame =
      params.around ? LineFrame::Around(params.around->center, extent.y.end) : LineFrame::At(params.angle);
  const LineProber prober(locator, border, frame, params, params.part, params.where, run);
  const double min_step = params.min_step_fraction * flat, once = frame.period();
  const Interval once_over = frame.round() ? Interval{extent.t.end - once, extent.t.end} : extent.t;
  const double sagitta = std::min(params.chord_tolerance, kRoundSagitta * flat);
  const double max_bend = frame.round() ? 0.0 : params.max_bend;
  PM_ASSIGN_OR_RETURN(const std::vector<LineBand> bands,
                      LinePositions(prober, extent, min_step, params.beside, run));
  std::vector<BentLine> bent;
  std::vector<char> last_of_band;
  for (const LineBand& band : bands) {
    PM_ASSIGN_OR_RETURN(const std::vector<BentLine> more,
                        BendLines(prober, extent.t, band, min_step, max_bend, run));
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
    if (!last_of_band[i]) FillGap(prober, lines[i], lines[i + 1], once_over, min_step, between[i]);
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
    const std::vector<Interval> keep = frame.round() ? OnceAround(line.keep, looked, once) : line.keep;
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
  PM_RETURN_IF_ERROR(ParallelFor(run, "zigzag", parts.size(), [&](std::size_t i) {
    const Part& part = parts[i];
    const LineShape& line = part.line->line;
    const std::vector<Vec2> places = frame.round() ? ArcPlaces(frame, line.At(part.t.begin), part.t, sagitta)
                                                   : PlacesOf(frame, line, part.t);
    runs[i] = ScanPolyline(locator, places, params, &run);
    if (places.front() == places.back()) closed[i] = CloseAround(CertificateGap(params), runs[i]);
  }));
  std::vector<CutterPath> paths;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    for (ScanRun& r : runs[i]) {
      if (r.points.size() < 2) continue;
      CutterPath path{.kind = PassKind::kZigzag,
                      .closed = closed[i] != 0,
                      .line = parts[i].index,
                      .points = std::move(r.points)};
      if (params.window.max >= kWallsToo) {
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
