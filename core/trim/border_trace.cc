#include "core/trim/border_trace.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include <absl/status/status.h>
#include <absl/strings/str_format.h>

#include "core/trim/strip_net.h"

namespace patchmill {
namespace {

constexpr double kSameCoordinate = 1e-8;
constexpr int kSamplesPerSpan = 16;
constexpr double kShortSide = 1e-5;  // mm: a side that is shorter may have no edge in the file

Vec2 HintAt(const std::vector<double>& at, const std::vector<Vec2>& places, double t) {
  const auto after = std::upper_bound(at.begin() + 1, at.end() - 1, t);
  const auto k = static_cast<std::size_t>(after - at.begin());
  const double part = std::clamp((t - at[k - 1]) / (at[k] - at[k - 1]), 0.0, 1.0);
  return places[k - 1] + part * (places[k] - places[k - 1]);
}

// The direction of the foot's way with respect to the curve's parameter.
Vec2 SlopeAt(const CarrierGrid& grid, const SpannedCurve& curve, const Vec2& place, double at) {
  const SurfaceJet jet = JetAt(grid, CellAt(grid, place), place);
  const Vec3 d = PointAt(curve, at).d;
  Eigen::Matrix2d g;
  const double uu = jet.du.squaredNorm(), vv = jet.dv.squaredNorm(), uv = jet.du.dot(jet.dv);
  g << uu, uv, uv, vv;
  g(0, 0) += 1e-13 * uu + 1e-20 * vv + 1e-300;
  g(1, 1) += 1e-13 * vv + 1e-20 * uu + 1e-300;
  return g.inverse() * Vec2(d.dot(jet.du), d.dot(jet.dv));
}

// UseTrace::area_beside.
double AreaBeside(const CarrierGrid& grid, const SpannedCurve& curve, const BrepEdgeUse& use,
                  const std::vector<Vec2>& hints) {
  double area = 0.0, last_off = 0.0;
  Vec3 last = Vec3::Zero();
  for (std::size_t k = 0; k < hints.size(); ++k) {
    const Vec3 p = PointAt(curve, use.hint_at[k]).p;
    const double off = std::min((PositionAt(grid, hints[k]) - p).norm(), kOpenLoop);
    if (k > 0) area += 0.5 * (last_off + off) * (p - last).norm();
    last = p;
    last_off = off;
  }
  return area;
}

// Samples of the edge, and their feet.
absl::StatusOr<UseTrace> TraceUse(const CarrierGrid& grid, const SpannedCurve& curve,
                                  const BrepEdgeUse& use) {
  UseTrace trace;
  trace.edge = use.edge;
  trace.forward = use.forward;
  if (use.hint.size() < 2 || use.hint.size() != use.hint_at.size()) {
    return absl::FailedPreconditionError(absl::StrFormat("edge %d has no way on the surface", use.edge));
  }
  std::vector<Vec2> hints;
  for (const Vec2& h : use.hint) hints.push_back(GridCoordinates(grid, h));
  trace.area_beside = AreaBeside(grid, curve, use, hints);
  std::vector<double> samples;
  for (const CurveSpan& span : curve.spans) {
    for (int k = 0; k < kSamplesPerSpan; ++k) {
      samples.push_back(span.from + (span.to - span.from) * k / kSamplesPerSpan);
    }
  }
  samples.push_back(curve.last());
  for (const double t : samples) {
    const Vec3 p = PointAt(curve, t).p;
    const Vec2 hint = HintAt(use.hint_at, hints, t);
    const std::optional<GridFoot> foot = FootOnGrid(grid, p, hint);
    if (!foot) {
      return absl::FailedPreconditionError(absl::StrFormat(
          "edge %d has no point of the surface beside it at %g %g %g", use.edge, p.x(), p.y(), p.z()));
    }
    trace.at.push_back(t);
    trace.places.push_back(foot->at);
    trace.gap = std::max(trace.gap, foot->distance);
    const SurfaceJet jet = JetAt(grid, CellAt(grid, foot->at), foot->at);
    trace.scale = trace.scale.cwiseMax(Vec2(jet.du.norm(), jet.dv.norm()));
  }
  return trace;
}

UseTrace DegenerateUse(const CarrierGrid& grid, const BrepEdgeUse& use) {
  UseTrace trace;
  trace.edge = use.edge;
  trace.forward = use.forward;
  trace.degenerate = true;
  trace.at = {0.0, 1.0};
  trace.places = {GridCoordinates(grid, use.hint.front()), GridCoordinates(grid, use.hint.back())};
  const Vec2 run = (trace.places[1] - trace.places[0]).cwiseAbs();
  trace.iso = run.x() >= run.y() ? 1 : 0;
  trace.constant = std::round(trace.places[0][trace.iso]);
  return trace;
}

// A coordinate of either kind that every place may be drawn to.
class Lines {
 public:
  void Add(int axis, double x) { at_[axis].push_back(Snapped(axis, x)); }
  double Snapped(int axis, double x) const {
    if (std::abs(x - std::round(x)) < kSameCoordinate) return std::round(x);
    for (const double line : at_[axis]) {
      if (std::abs(x - line) < kSameCoordinate) return line;
    }
    return x;
  }

 private:
  std::vector<double> at_[2];
};

// Decides whether an edge is an iso-parametric line.
void FindIso(UseTrace& trace, double tolerance) {
  const double most = std::max(tolerance, 2.0 * trace.gap);
  double best = kInfinity;
  for (int axis = 0; axis < 2; ++axis) {
    double low = kInfinity, high = -kInfinity;
    for (const Vec2& p : trace.places) {
      low = std::min(low, p[axis]);
      high = std::max(high, p[axis]);
    }
    const double off = 0.5 * (high - low) * trace.scale[axis];
    if (off <= most && off < best) {
      best = off;
      trace.iso = axis;
      trace.constant = 0.5 * (low + high);
      // A grid line that the edge follows as well as its own mean.
      const double line = std::round(trace.constant);
      if (std::abs(trace.constant - line) * trace.scale[axis] <= most) trace.constant = line;
    }
  }
}

// A straight side for which the file has no edge, as the end of a strip that is narrower than the file's
// accuracy. Both ends are drawn to a grid line, or to the line that both neighbours end at, along the
// coordinate that differs less.
UseTrace ShortSide(UseTrace& one, UseTrace& next, const Lines& lines) {
  Vec2 a = one.end(), b = next.begin();
  const int axis = std::abs(a.x() - b.x()) < std::abs(a.y() - b.y()) ? 0 : 1;
  const double both = lines.Snapped(axis, one.iso == axis    ? one.constant
                                          : next.iso == axis ? next.constant
                                                             : 0.5 * (a[axis] + b[axis]));
  a[axis] = b[axis] = both;
  (one.forward ? one.places.back() : one.places.front()) = a;
  (next.forward ? next.places.front() : next.places.back()) = b;
  UseTrace side;
  side.iso = axis;
  side.constant = both;
  side.at = {0.0, 1.0};
  side.places = {a, b};
  return side;
}

// A degenerate edge between neighbours that meet on the surface, as some systems leave behind at a corner:
// it is no pole, and wherever the file has it, it stays at the end of the edge before.
void PullNeedlessPoles(std::vector<UseTrace>& loop) {
  const auto count = loop.size();
  for (std::size_t k = 0; count > 2 && k < count; ++k) {
    UseTrace& pole = loop[k];
    const UseTrace &before = loop[(k + count - 1) % count], &after = loop[(k + 1) % count];
    if (!pole.degenerate || before.degenerate || after.degenerate) continue;
    const Vec2 a = before.end();
    if ((a - after.begin()).cwiseAbs().maxCoeff() > 0.25) continue;
    pole.iso = after.iso == 0 ? 1 : 0;
    pole.constant = before.iso == pole.iso ? before.constant : a[pole.iso];
    pole.places = {a, a};
  }
}

// Makes neighbours in the loop meet. A degenerate edge is drawn between its neighbours, and sides are made
// where the loop jumps over one.
absl::StatusOr<std::vector<UseTrace>> CloseLoop(const CarrierGrid& grid, std::vector<UseTrace>& loop,
                                                const Lines& lines) {
  std::vector<UseTrace> sides;
  const auto count = loop.size();
  for (std::size_t k = 0; k < count; ++k) {
    UseTrace &one = loop[k], &next = loop[(k + 1) % count];
    const Vec2 a = one.end(), b = next.begin();
    Vec2 corner;
    for (int axis = 0; axis < 2; ++axis) {
      double x = 0.5 * (a[axis] + b[axis]);
      if (one.degenerate != next.degenerate) x = one.degenerate ? b[axis] : a[axis];
      if (next.iso == axis) x = next.constant;
      if (one.iso == axis) x = one.constant;
      corner[axis] = lines.Snapped(axis, x);
    }
    const double apart = (PositionAt(grid, a) - PositionAt(grid, b)).norm();
    const bool pole = one.degenerate || next.degenerate;
    const double slack = 1e-6 + 10.0 * (one.gap + next.gap) + 1e-7 * grid.size;
    const bool jumps = !pole && (a - b).cwiseAbs().maxCoeff() > 0.25;
    if (jumps && apart <= std::max(slack, kShortSide)) {
      sides.push_back(ShortSide(one, next, lines));
      continue;
    }
    if (jumps || apart > std::max(slack, kOpenLoop)) {
      return absl::FailedPreconditionError(absl::StrFormat(
          "the loop is open between the edges %d and %d, by %g mm", one.edge, next.edge, apart));
    }
    (one.forward ? one.places.back() : one.places.front()) = corner;
    (next.forward ? next.places.front() : next.places.back()) = corner;
  }
  return sides;
}

// Finds a place between a and b at which f changes its sign, where fa = f(a) and fb = f(b). False position,
// with a halving in every third round.
template <class F>
double ZeroBetween(double a, double fa, double b, double fb, const F& f) {
  for (int round = 0; round < 60 && b - a > 1e-14 * std::max(1.0, std::abs(b)); ++round) {
    double x = a - fa * (b - a) / (fb - fa);
    if (round % 3 == 2 || !(x > a && x < b)) x = 0.5 * (a + b);
    const double fx = f(x);
    if (fx == 0.0) return x;
    if ((fx < 0.0) == (fa < 0.0)) {
      a = x;
      fa = fx;
    } else {
      b = x;
      fb = fx;
    }
  }
  return 0.5 * (a + b);
}

}  // namespace

absl::StatusOr<BorderTrace> TraceBorder(const BrepFace& face, const EdgeCurveTable& curves,
                                        const CarrierGrid& grid, double iso_tolerance) {
  BorderTrace border;
  Lines lines;
  for (const BrepLoop& loop : face.loops) {
    std::vector<UseTrace>& traces = border.loops.emplace_back();
    for (const BrepEdgeUse& use : loop) {
      const SpannedCurve& curve = curves[static_cast<std::size_t>(use.edge)];
      if (curve.spans.empty()) {
        traces.push_back(DegenerateUse(grid, use));
      } else {
        absl::StatusOr<UseTrace> trace = TraceUse(grid, curve, use);
        if (!trace.ok()) return trace.status();
        FindIso(*trace, iso_tolerance);
        traces.push_back(*std::move(trace));
      }
      UseTrace& trace = traces.back();
      if (trace.iso >= 0) {
        trace.constant = lines.Snapped(trace.iso, trace.constant);
        lines.Add(trace.iso, trace.constant);
      }
      border.gap = std::max(border.gap, trace.gap);
      border.area_beside += trace.area_beside;
    }
  }
  for (std::vector<UseTrace>& loop : border.loops) {
    for (UseTrace& trace : loop) {
      for (Vec2& p : trace.places) {
        if (trace.iso >= 0) p[trace.iso] = trace.constant;
        for (int axis = 0; axis < 2; ++axis) p[axis] = lines.Snapped(axis, p[axis]);
      }
    }
    PullNeedlessPoles(loop);
    absl::StatusOr<std::vector<UseTrace>> sides = CloseLoop(grid, loop, lines);
    if (!sides.ok()) return sides.status();
    for (UseTrace& side : *sides) border.short_sides.push_back(std::move(side));
  }
  return border;
}

Vec2 PlaceAt(const CarrierGrid& grid, const SpannedCurve& curve, const UseTrace& trace, double at) {
  if (at <= trace.at.front()) return trace.places.front();
  if (at >= trace.at.back()) return trace.places.back();
  const Vec2 near = HintAt(trace.at, trace.places, at);
  const std::optional<GridFoot> foot = FootOnGrid(grid, PointAt(curve, at).p, near);
  Vec2 place = foot ? foot->at : near;
  for (int axis = 0; axis < 2; ++axis) {
    if (std::abs(place[axis] - std::round(place[axis])) < kSameCoordinate)
      place[axis] = std::round(place[axis]);
  }
  if (trace.iso >= 0) place[trace.iso] = trace.constant;
  return place;
}

std::vector<double> NaturalBreaks(const CarrierGrid& grid, const SpannedCurve& curve, const UseTrace& trace) {
  std::vector<double> breaks;
  if (trace.degenerate) return breaks;
  const auto place = [&](double t) { return PlaceAt(grid, curve, trace, t); };
  const auto slope = [&](double t) { return SlopeAt(grid, curve, place(t), t); };
  // Positive where the way is flatter than 45 degrees.
  const auto flat = [&](double t) {
    const Vec2 p = place(t), d = SlopeAt(grid, curve, p, t);
    const SurfaceJet jet = JetAt(grid, CellAt(grid, p), p);
    return std::abs(d.x()) * jet.du.norm() - std::abs(d.y()) * jet.dv.norm();
  };
  const auto add_zero = [&](double a, double b, const auto& f) {
    const double fa = f(a), fb = f(b);
    if (fa != 0.0 && fb != 0.0 && (fa < 0.0) != (fb < 0.0)) breaks.push_back(ZeroBetween(a, fa, b, fb, f));
  };
  for (std::size_t k = 0; k + 1 < trace.at.size(); ++k) {
    const double a = trace.at[k], b = trace.at[k + 1];
    const Vec2 &pa = trace.places[k], &pb = trace.places[k + 1];
    for (int axis = 0; axis < 2; ++axis) {
      if (trace.iso == axis) continue;
      const double low = std::min(pa[axis], pb[axis]), high = std::max(pa[axis], pb[axis]);
      for (double line = std::floor(low) + 1.0; line < high; line += 1.0) {
        if (line <= low) continue;
        const auto beyond = [&](double t) { return place(t)[axis] - line; };
        breaks.push_back(ZeroBetween(a, pa[axis] - line, b, pb[axis] - line, beyond));
      }
      if (pa[axis] == std::round(pa[axis]) && k > 0) breaks.push_back(a);
    }
    if (trace.iso >= 0) continue;
    add_zero(a, b, [&](double t) { return slope(t).x(); });
    add_zero(a, b, [&](double t) { return slope(t).y(); });
    add_zero(a, b, flat);
  }
  std::sort(breaks.begin(), breaks.end());
  return breaks;
}

FittedGraph FitGraph(const CarrierGrid& grid, const SpannedCurve& curve, const UseTrace& trace, double from,
                     double to) {
  const Vec2 a = PlaceAt(grid, curve, trace, from), b = PlaceAt(grid, curve, trace, to);
  if (trace.iso >= 0 || a.x() == b.x() || a.y() == b.y()) return {StraightGraph(a, b), 0.0};
  const Vec2 middle = PlaceAt(grid, curve, trace, 0.5 * (from + to));
  const GridCell cell = CellAt(grid, 0.5 * (a + b));
  const SurfaceJet jet = JetAt(grid, cell, middle);
  const BernsteinNet& net = grid.carrier(cell.i, cell.j).net;
  const double run_u = std::abs(b.x() - a.x()) * jet.du.norm(),
               run_v = std::abs(b.y() - a.y()) * jet.dv.norm();
  FittedGraph fit;
  GridGraph& graph = fit.graph;
  graph.along_u = run_u >= run_v;
  const int degree = LargestStripDegree(net, graph.along_u);
  const int axis = graph.along_u ? 0 : 1;
  const bool rises = b[axis] > a[axis];
  graph.from = rises ? a[axis] : b[axis];
  graph.to = rises ? b[axis] : a[axis];
  // The other coordinate where the way has this one.
  const auto value = [&](double x) {
    const auto beyond = [&](double t) { return PlaceAt(grid, curve, trace, t)[axis] - x; };
    const double t = ZeroBetween(from, a[axis] - x, to, b[axis] - x, beyond);
    const Vec2 place = PlaceAt(grid, curve, trace, t);
    // A place that is no foot of the edge counts as an error of the graph.
    const double off = (PositionAt(grid, place) - PointAt(curve, t).p).norm();
    if (!(off <= 2.0 * trace.gap + 1e-6))
      fit.error = std::max(fit.error, std::isfinite(off) ? off : grid.size);
    return place[1 - axis];
  };
  std::vector<double> values;
  for (int k = 0; k <= degree; ++k) {
    const bool first = k == 0, last = k == degree;
    const double x = graph.from + (graph.to - graph.from) * k / degree;
    values.push_back(first ? (rises ? a : b)[1 - axis] : (last ? (rises ? b : a)[1 - axis] : value(x)));
  }
  graph.c = ThroughValues(values);
  const double per_unit = graph.along_u ? jet.dv.norm() : jet.du.norm();
  for (int k = 0; k < 8; ++k) {
    const double x = graph.from + (graph.to - graph.from) * (k + 0.5) / 8.0;
    fit.error = std::max(fit.error, std::abs(ValueAt(graph, x) - value(x)) * per_unit);
  }
  return fit;
}

}  // namespace patchmill
