#include "cam/path/parallel/line_clip.h"

#include <algorithm>
#include <cmath>

namespace patchmill {
namespace {

constexpr double kSolved = 1e-9;     // mm: accuracy of ends
constexpr double kAtSide = 1e-9;     // of a piece's parameters: a contact this near to a side lies on it
constexpr double kNarrowest = 0.02;  // flat step-overs: narrower faces between edges are not looked for

class Clipper {
 public:
  Clipper(const LineProber& prober, const LineShape& line)
      : prober_(prober), line_(line), flat_(prober.flat_step()) {}

  std::vector<LineProbe> Stations(const Interval& range) const;
  std::vector<Interval> Keep(const std::vector<LineProbe>& stations) const;

 private:
  LineProbe Probe(double t, const LineProbe& near) const {
    return prober_.Probe(t, line_.At(t), line_.SlopeAt(t), near.contact ? &*near.contact : nullptr);
  }
  void Subdivide(const LineProbe& a, const LineProbe& b, std::vector<LineProbe>& out) const;
  bool WantedBeside(const LineProbe& s) const;
  bool FaceBetween(const LineProbe& a, const LineProbe& b) const;
  bool FaceBetween(const std::vector<LineProbe>& stations, std::size_t first, std::size_t last) const;
  template <class Predicate>
  LineProbe Limit(LineProbe yes, LineProbe no, Predicate holds) const;
  double Extend(const std::vector<LineProbe>& stations, std::size_t next, const LineProbe& from,
                int direction) const;

  const LineProber& prober_;
  const LineShape& line_;
  const double flat_;
};

void Clipper::Subdivide(const LineProbe& a, const LineProbe& b, std::vector<LineProbe>& out) const {
  const bool far = a.exists() && b.exists() && (a.center - b.center).norm() > 1.2 * flat_;
  if (far && b.t - a.t > 0.04 * flat_) {
    const LineProbe m = Probe(0.5 * (a.t + b.t), a);
    Subdivide(a, m, out);
    Subdivide(m, b, out);
    return;
  }
  out.push_back(b);
}

std::vector<LineProbe> Clipper::Stations(const Interval& range) const {
  const int count = std::max(1, static_cast<int>(std::ceil((range.end - range.begin) / (0.6 * flat_))));
  const std::vector<LineProbe> row = prober_.ProbeRow(range.begin, range.end, count, line_);
  std::vector<LineProbe> out = {row.front()};
  for (std::size_t i = 1; i < row.size() && !prober_.Cancelled(); ++i) Subdivide(row[i - 1], row[i], out);
  return out;
}

// Dilates across the line: does the window begin within half a step beside this place?
bool Clipper::WantedBeside(const LineProbe& s) const {
  for (int side : {-1, 1}) {
    const LineProbe beside = prober_.Probe(s.t, line_.At(s.t) + side * s.lateral, line_.SlopeAt(s.t),
                                           s.contact ? &*s.contact : nullptr);
    if (beside.finishes && (beside.center - s.center).norm() <= 1.5 * s.half_step) return true;
  }
  return false;
}

bool OnOneSide(const SurfacePoint& a, const SurfacePoint& b) {
  const auto both = [](double s, double t) {
    return std::max(s, t) < kAtSide || std::min(s, t) > 1.0 - kAtSide;
  };
  return a.piece.value == b.piece.value && (both(a.u, b.u) || both(a.v, b.v));
}

// Between places over different edges there may be a face narrower than the distance of the places.
bool Clipper::FaceBetween(const LineProbe& a, const LineProbe& b) const {
  if (!a.contact || !b.contact || OnOneSide(*a.contact, *b.contact)) return false;
  if (b.t - a.t < kNarrowest * flat_ || prober_.Cancelled()) return false;
  const LineProbe m = Probe(0.5 * (a.t + b.t), a);
  return m.finishes || FaceBetween(a, m) || FaceBetween(m, b);
}

bool Clipper::FaceBetween(const std::vector<LineProbe>& stations, std::size_t first, std::size_t last) const {
  for (std::size_t k = first == 0 ? 0 : first - 1; k <= last && k + 1 < stations.size(); ++k) {
    if (FaceBetween(stations[k], stations[k + 1])) return true;
  }
  return false;
}

// Returns the last place, going from `yes` to `no`, where the predicate holds.
template <class Predicate>
LineProbe Clipper::Limit(LineProbe yes, LineProbe no, Predicate holds) const {
  while (std::abs(no.t - yes.t) > kSolved) {
    const double mid = 0.5 * (yes.t + no.t);
    if (mid == yes.t || mid == no.t) break;  // no number lies between them any more
    const LineProbe m = Probe(mid, yes);
    (holds(m) ? yes : no) = m;
  }
  return yes;
}

// Goes from `from` through allowed places until half a step of the centre curve is used up. `next` is the
// first station beyond `from`. Stops at open edges, gaps and drops, which are solved.
double Clipper::Extend(const std::vector<LineProbe>& stations, std::size_t next, const LineProbe& from,
                       int direction) const {
  double left = std::max(0.5 * flat_, from.half_step) * 1.01;
  LineProbe at = from;
  for (std::size_t i = next; i < stations.size(); i += static_cast<std::size_t>(direction)) {
    LineProbe to = stations[i];
    if (!to.allowed) to = Limit(at, to, [](const LineProbe& p) { return p.allowed; });
    double d = (to.center - at.center).norm();
    while (d > left) {  // too far: come back, half the way each time
      if (std::abs(to.t - at.t) < 1e-3 * flat_) return at.t;
      const LineProbe m = Probe(0.5 * (at.t + to.t), at);
      const double dm = (m.center - at.center).norm();
      if (m.allowed && dm <= left) {
        left -= dm;
        at = m;
      } else {
        to = m;
      }
      d = to.allowed ? (to.center - at.center).norm() : kInfinity;
    }
    left -= d;
    at = to;
    if (to.t != stations[i].t) return at.t;  // an open edge, or the length is used up
  }
  return at.t;
}

std::vector<Interval> Clipper::Keep(const std::vector<LineProbe>& stations) const {
  std::vector<Interval> keep;
  const auto wanted = [](const LineProbe& p) { return p.wanted; };
  const auto allowed = [](const LineProbe& p) { return p.allowed; };
  const std::size_t n = stations.size();
  for (std::size_t i = 0; i < n && !prober_.Cancelled(); ++i) {
    const LineProbe& s = stations[i];
    if (!s.allowed) continue;
    if (!s.wanted) {
      if (!WantedBeside(s)) continue;
      const auto reach = [&](std::size_t j) {
        return stations[j].allowed ? 0.5 * (s.t + stations[j].t) : Limit(s, stations[j], allowed).t;
      };
      keep.push_back({i > 0 ? reach(i - 1) : s.t, i + 1 < n ? reach(i + 1) : s.t});
      continue;
    }
    std::size_t last = i;
    while (last + 1 < n && stations[last + 1].wanted) ++last;
    // If all of the stretch lies over an edge, nothing is finished there.
    const std::size_t first = i;
    i = last;
    const auto at = [&](std::size_t k) { return stations.begin() + static_cast<std::ptrdiff_t>(k); };
    if (std::none_of(at(first), at(last + 1), [](const LineProbe& p) { return p.finishes; }) &&
        !FaceBetween(stations, first, last)) {
      continue;
    }
    Interval part{s.t, stations[last].t};
    if (first > 0) part.begin = Extend(stations, first - 1, Limit(s, stations[first - 1], wanted), -1);
    if (last + 1 < n)
      part.end = Extend(stations, last + 1, Limit(stations[last], stations[last + 1], wanted), 1);
    keep.push_back(part);
  }
  return keep;
}

}  // namespace

std::vector<Interval> Union(std::vector<Interval> intervals, double gap) {
  std::sort(intervals.begin(), intervals.end(),
            [](const Interval& a, const Interval& b) { return a.begin < b.begin; });
  std::vector<Interval> out;
  for (const Interval& i : intervals) {
    if (!out.empty() && i.begin <= out.back().end + gap) {
      out.back().end = std::max(out.back().end, i.end);
    } else {
      out.push_back(i);
    }
  }
  return out;
}

std::vector<Interval> Common(const std::vector<Interval>& a, const std::vector<Interval>& b) {
  std::vector<Interval> out;
  for (std::size_t i = 0, k = 0; i < a.size() && k < b.size();) {
    const Interval both{std::max(a[i].begin, b[k].begin), std::min(a[i].end, b[k].end)};
    if (both.begin < both.end) out.push_back(both);
    a[i].end < b[k].end ? ++i : ++k;
  }
  return out;
}

ClippedLine ClipLine(const LineProber& prober, const LineShape& line, double rank, const Interval& range) {
  const Clipper clipper(prober, line);
  ClippedLine clipped{line, rank, {}, clipper.Stations(range)};
  clipped.keep = Union(clipper.Keep(clipped.probes), 0.0);
  return clipped;
}

}  // namespace patchmill
