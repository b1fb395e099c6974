#include "cam/path/parallel/line_gaps.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "cam/path/stepover/step_over.h"

namespace patchmill {
namespace {

constexpr double kShortest = 4.0;  // flat step-overs: a shorter stretch of lines joins its neighbour

// A stretch of the gap between two lines that must be divided into `parts`.
struct Stretch {
  Interval t;
  int parts = 2;
};

// Returns `within` without `less`. Both must be rising and disjoint.
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

// Returns the number of parts into which the gap between a place of one line and another line must be
// divided. Where one of the two lines needs less than the gap, the place half way is probed too, and counts
// most by Simpson's rule: the surface rises between two places by its mean curvature, with weights that rise
// towards the middle.
int PartsTowards(const LineProber& prober, const LineProbe& p, const ClippedLine& line,
                 const ClippedLine& other) {
  const double y = line.line.At(p.t), across = other.line.At(p.t) - y;
  const auto parts = [&](double need) {
    return PartsOfGap(std::abs(across), kWideGap * need, prober.min_step());
  };
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

// Returns where two lines need a neighbour nearer than the other line, and the number of parts needed there.
std::vector<Stretch> NarrowStretches(const LineProber& prober, const ClippedLine& a, const ClippedLine& b,
                                     const Interval& within) {
  const double flat = prober.flat_step();
  std::map<int, std::vector<Interval>> spots;
  for (const ClippedLine* line : {&a, &b}) {
    for (const LineProbe& p : line->probes) {
      if (!p.wanted || p.t < within.begin || p.t > within.end) continue;
      const int parts = PartsTowards(prober, p, *line, line == &a ? b : a);
      if (parts > 1)
        spots[parts].push_back({std::max(within.begin, p.t - flat), std::min(within.end, p.t + flat)});
    }
  }
  // Stretches are nested, from the fewest parts up. A stretch that needs more parts lies within one that
  // needs fewer, and takes over its ends where they are near.
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

}  // namespace

void FillGap(const LineProber& prober, const ClippedLine& a, const ClippedLine& b, const Interval& within,
             std::vector<ClippedLine>& out) {
  if (prober.Cancelled()) return;
  for (const Stretch& stretch : NarrowStretches(prober, a, b, within)) {
    ClippedLine last = a;
    for (int k = 1; k < stretch.parts; ++k) {
      const double share = static_cast<double>(k) / stretch.parts;
      ClippedLine line =
          ClipLine(prober, Between(a.line, b.line, share), a.rank + (b.rank - a.rank) * share, stretch.t);
      FillGap(prober, last, line, stretch.t, out);
      out.push_back(line);
      last = std::move(line);
    }
    FillGap(prober, last, b, stretch.t, out);
  }
}

}  // namespace patchmill
