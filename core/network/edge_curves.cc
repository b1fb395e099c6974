#include "core/network/edge_curves.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/parallel.h"
#include "core/base/status.h"

namespace patchmill {
namespace {

constexpr int kMinSteps = 8;
constexpr int kMaxSteps = 256;

// Direction of growing t along each edge, in native parameters.
Vec2 EdgeDirection(const PatchShape& shape, int edge) {
  return EdgeParameters(shape, edge, 1.0) - EdgeParameters(shape, edge, 0.0);
}

int SplineSteps(const std::vector<double>& knots, int degree) {
  int spans = 0;
  for (std::size_t i = 1; i < knots.size(); ++i) spans += knots[i] > knots[i - 1] ? 1 : 0;
  return spans * (degree + 1);
}

int Steps(const PatchShape& shape, int edge) {
  int steps = kMinSteps;
  if (const auto* b = std::get_if<BezierPatch>(&shape)) {
    steps = 2 * (edge % 2 == 0 ? b->degree_u : b->degree_v);
  } else if (const auto* t = std::get_if<BezierTriangle>(&shape)) {
    steps = 2 * t->degree;
  } else if (const auto* q = std::get_if<BrownPatch>(&shape)) {
    const auto spans = static_cast<int>((edge % 2 == 0 ? q->breaks_u : q->breaks_v).size()) + 1;
    steps = 2 * spans * (edge % 2 == 0 ? q->degree_u : q->degree_v);
  } else if (const auto* g = std::get_if<G2GregoryPatch>(&shape)) {
    steps = 2 * g->degree;
  } else if (const auto* h = std::get_if<HosakaPatch>(&shape)) {
    steps = 2 * h->degree;
  } else if (const auto* s = std::get_if<BsplinePatch>(&shape)) {
    steps = edge % 2 == 0 ? SplineSteps(s->knots_u, s->degree_u) : SplineSteps(s->knots_v, s->degree_v);
  }
  return std::clamp(steps, kMinSteps, kMaxSteps);
}

// Golden section on [lo, hi]: needs no derivative.
EdgeFoot GoldenSection(const EdgeCurves& curves, int e, const Vec3& p, double lo, double hi) {
  const double ratio = 0.5 * (std::sqrt(5.0) - 1.0);
  const auto distance = [&](double t) { return (curves.Point(e, t) - p).norm(); };
  double a = hi - ratio * (hi - lo), b = lo + ratio * (hi - lo);
  double fa = distance(a), fb = distance(b);
  for (int i = 0; i < 40; ++i) {
    if (fa <= fb) {
      hi = b, b = a, fb = fa;
      fa = distance(a = hi - ratio * (hi - lo));
    } else {
      lo = a, a = b, fa = fb;
      fb = distance(b = lo + ratio * (hi - lo));
    }
  }
  return fa <= fb ? EdgeFoot{a, fa} : EdgeFoot{b, fb};
}

// The foot on the polyline of the samples, as a parameter of the edge.
double PolylineFoot(std::span<const Vec3> samples, const Vec3& p) {
  double best = kInfinity, best_t = 0.0;
  const double steps = static_cast<double>(samples.size() - 1);
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    const Vec3 d = samples[i + 1] - samples[i];
    const double dd = d.squaredNorm();
    const double s = dd > 0.0 ? std::clamp((p - samples[i]).dot(d) / dd, 0.0, 1.0) : 0.0;
    const double distance = (samples[i] + s * d - p).squaredNorm();
    if (distance < best) best = distance, best_t = (static_cast<double>(i) + s) / steps;
  }
  return best_t;
}

// Two edges, and whether their parameters run against each other.
struct EdgePair {
  int from, onto;
  bool reversed;
};

// Largest distance from a sample of one edge to the other. Distances of points of equal parameter up to
// `enough` are taken as they are.
double OneSidedDistance(const EdgeCurves& curves, const EdgePair& pair, double limit, double enough) {
  const std::span<const Vec3> from = curves.samples(pair.from);
  const std::span<const Vec3> onto = curves.samples(pair.onto);
  const bool aligned = from.size() == onto.size();
  double worst = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const std::size_t j = pair.reversed ? from.size() - 1 - i : i;
    double d = aligned ? (from[i] - onto[j]).norm() : kInfinity;
    if (!(d <= enough)) d = std::min(d, ClosestOnEdge(curves, pair.onto, from[i]).distance);
    worst = std::max(worst, d);
    if (worst > limit) break;
  }
  return worst;
}

}  // namespace

int EdgeCount(const PatchShape& shape) { return IsTriangle(shape) ? 3 : 4; }

Vec2 EdgeParameters(const PatchShape& shape, int edge, double t) {
  if (IsTriangle(shape)) {
    PM_CHECK(edge >= 0 && edge < 3);
    if (edge == 0) return {t, 0.0};
    return edge == 1 ? Vec2(1.0 - t, t) : Vec2(0.0, t);
  }
  PM_CHECK(edge >= 0 && edge < 4);
  switch (edge) {
    case 0:
      return {t, 0.0};
    case 1:
      return {1.0, t};
    case 2:
      return {t, 1.0};
    default:
      return {0.0, t};
  }
}

EdgeCurves::EdgeCurves(const PatchModel& model, const RunContext& run) : model_(&model) {
  std::size_t samples = 0;
  for (std::size_t k = 0; k < model.patches.size(); ++k) {
    const PatchShape& shape = model.patches[k].shape;
    first_edge_.push_back(count());
    for (int edge = 0; edge < EdgeCount(shape); ++edge) {
      edges_.push_back({PatchId(k), edge});
      first_sample_.push_back(samples);
      samples += static_cast<std::size_t>(Steps(shape, edge)) + 1;
    }
  }
  first_sample_.push_back(samples);
  samples_.resize(samples);
  // A cancelled run leaves zeros behind. BuildNetwork checks the run next.
  (void)ParallelFor(run, "joins: edges", edges_.size(), [&](std::size_t e) {
    const std::size_t begin = first_sample_[e], end = first_sample_[e + 1];
    const double steps = static_cast<double>(end - begin - 1);
    for (std::size_t i = begin; i < end; ++i) {
      samples_[i] = Point(static_cast<int>(e), static_cast<double>(i - begin) / steps);
    }
  });
}

std::span<const Vec3> EdgeCurves::samples(int e) const {
  const auto k = static_cast<std::size_t>(e);
  return std::span<const Vec3>(samples_).subspan(first_sample_[k], first_sample_[k + 1] - first_sample_[k]);
}

double EdgeCurves::length(int e) const {
  const std::span<const Vec3> p = samples(e);
  double sum = 0.0;
  for (std::size_t i = 1; i < p.size(); ++i) sum += (p[i] - p[i - 1]).norm();
  return sum;
}

double EdgeCurves::reach(int e) const {
  double reach = 0.0;
  for (const Vec3& p : samples(e)) reach = std::max(reach, (p - start(e)).norm());
  return reach;
}

Box3 EdgeCurves::box(int e) const {
  const std::span<const Vec3> p = samples(e);
  Box3 box;
  double bend =
      0.0;  // a parabola through three samples leaves its chord by an eighth of the second difference
  for (std::size_t i = 0; i < p.size(); ++i) {
    box.Add(p[i]);
    if (i >= 2) bend = std::max(bend, (p[i] - 2.0 * p[i - 1] + p[i - 2]).norm());
  }
  box.min.array() -= 0.25 * bend;
  box.max.array() += 0.25 * bend;
  return box;
}

Vec3 EdgeCurves::Point(int e, double t) const {
  const Vec2 uv = EdgeParameters(shape(e), edge(e).edge, t);
  return Position(shape(e), uv.x(), uv.y());
}

EdgeFoot ClosestOnEdge(const EdgeCurves& curves, int e, const Vec3& p) {
  const std::span<const Vec3> samples = curves.samples(e);
  const PatchShape& shape = curves.shape(e);
  const int edge = curves.edge(e).edge;
  const Vec2 direction = EdgeDirection(shape, edge);
  const double step = 1.0 / static_cast<double>(samples.size() - 1);
  const double t0 = PolylineFoot(samples, p);
  const double lo = std::max(0.0, t0 - step), hi = std::min(1.0, t0 + step);

  EdgeFoot best{t0, kInfinity};
  double t = t0;
  for (int i = 0; i < 12; ++i) {
    const Vec2 uv = EdgeParameters(shape, edge, t);
    const SurfaceJet jet = Evaluate(shape, uv.x(), uv.y());
    const double distance = (jet.p - p).norm();
    if (distance < best.distance) best = {t, distance};
    const Vec3 tangent = direction.x() * jet.du + direction.y() * jet.dv;
    const double tt = tangent.squaredNorm();
    const double next = tt > 0.0 ? std::clamp(t + (p - jet.p).dot(tangent) / tt, lo, hi) : kInfinity;
    if (std::abs(next - t) < 1e-12) return best;
    if (!(next <= hi)) break;
    t = next;
  }
  const EdgeFoot slow = GoldenSection(curves, e, p, lo, hi);
  return slow.distance < best.distance ? slow : best;
}

bool EdgesAgree(const EdgeCurves& curves, int a, int b, bool reversed, double tolerance) {
  return OneSidedDistance(curves, {a, b, reversed}, tolerance, tolerance) <= tolerance &&
         OneSidedDistance(curves, {b, a, reversed}, tolerance, tolerance) <= tolerance;
}

double EdgeDistance(const EdgeCurves& curves, int a, int b, bool reversed, double limit) {
  const double there = OneSidedDistance(curves, {a, b, reversed}, limit, 0.1 * limit);
  if (there > limit) return there;
  return std::max(there, OneSidedDistance(curves, {b, a, reversed}, limit, 0.1 * limit));
}

}  // namespace patchmill
