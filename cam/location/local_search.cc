#include "cam/location/local_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace patchmill::internal {
namespace {

constexpr int kMaxIterations = 200;
constexpr int kMaxHalvings = 30;
// After so many iterations every other step models g in place of f. Steps on concave or flat surface go as
// far as the model falls. A search whose model stays out of the ball ends.
constexpr int kSlowIterations = 6;
constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();
// The search stops when the model promises less (mm of height). Below kFinishGain the last step is taken on
// the Taylor polynomial, whose error is of third order in a step of about 1e-4 mm.
constexpr double kFinishGain = 1e-9;
constexpr double kStopGain = 1e-13;
// The last step must also be short in parameters. Beside a pole a short step in space turns them far.
constexpr double kLastStep = 1e-3;

struct State {
  double u, v;
  SurfaceJet jet;
  Vec3 d;    // from the surface point to the ray
  double f;  // 1/2 |d|^2
};

// Height of the centre that touches p; -infinity if p is not under the ball. A point at the ball's rim,
// within rounding, is outside, as in the proofs (FreeF). So a ball exactly beside a wall is free.
double TouchingHeight(const Vec3& p, const Ball& ball) {
  const double dx = p.x() - ball.q.x(), dy = p.y() - ball.q.y();
  const double rim = ball.radius * ball.radius - (dx * dx + dy * dy);
  return rim > 2.0 * ball.radius * ball.slack ? p.z() + std::sqrt(rim) : -kInfinity;
}

void Measure(const Ball& ball, double z, State& s) {
  s.d = ToRay(s.jet.p, Lift(ball.q, z));
  s.f = 0.5 * s.d.squaredNorm();
}

struct Step {
  Quadratic2 model;    // model of f around the state
  bool exact = false;  // the model holds the true Hessian and is well conditioned
  BoxMinimum to;
};

// Makes the Hessian positive definite with respect to the metric e, f, g: replaces its eigenvalues by their
// absolute values, at least kFloor. True curvatures are kept, so convex directions converge as before.
void MakeDefinite(double e, double f, double g, double tiny, Quadratic2& m) {
  constexpr double kFloor = 1e-3;
  tiny = std::max(tiny, 1e-300);
  const double l11 = std::sqrt(e + tiny), l21 = f / l11,
               l22 = std::sqrt(std::max(g + tiny - l21 * l21, tiny));
  // A = L^-1 H L^-T
  const double a = m.a / (l11 * l11), b = (m.b - l21 * l11 * a) / (l11 * l22);
  const double c = (m.c - l21 * (l21 * a + 2.0 * l22 * b)) / (l22 * l22);
  const double middle = 0.5 * (a + c), half = 0.5 * (a - c), radius = std::sqrt(half * half + b * b);
  const double high = std::max(std::abs(middle + radius), kFloor);
  const double low = std::max(std::abs(middle - radius), kFloor);
  // high w w^T + low (1 - w w^T), w the eigenvector of middle + radius
  double ww = 1.0, wx = 0.0;  // cos^2 and sin cos of its angle
  if (radius > 0.0) {
    ww = 0.5 * (1.0 + half / radius);
    wx = 0.5 * b / radius;
  }
  const double na = high * ww + low * (1.0 - ww), nb = (high - low) * wx, nc = high * (1.0 - ww) + low * ww;
  m.a = l11 * l11 * na;
  m.b = l11 * (l21 * na + l22 * nb);
  m.c = l21 * (l21 * na + 2.0 * l22 * nb) + l22 * l22 * nc;
}

// A step along one parameter line, and the value of the model there. The other variable is held by its bound.
struct LineStep {
  double length, value;
};
LineStep StepOnLine(double curvature, double metric, double slope, double lo, double hi) {
  const double used = std::max(std::abs(curvature), 1e-3 * metric + 1e-300);
  const double step = std::clamp(-slope / used, lo, hi);
  return {step, step * (slope + 0.5 * used * step)};
}

// If the ball touches a steep wall near its own equator, the model of f = 1/2 dist^2 makes little progress: f
// hardly falls along the wall, yet g rises with z. This step uses the exact second-order model of -s g,
// s = d_z, instead. It may be unbounded and then leads to the border.
Step RiseStep(const State& s, const Box2& box) {
  Step step;
  const SurfaceJet& j = s.jet;
  const Vec3& d = s.d;
  const double qu = d.x() * j.du.x() + d.y() * j.du.y(), qv = d.x() * j.dv.x() + d.y() * j.dv.y();
  const double scale = 1.0 / (d.z() * d.z());
  Quadratic2& m = step.model;
  m.gx = -d.dot(j.du);
  m.gy = -d.dot(j.dv);
  m.a = j.du.head<2>().squaredNorm() + qu * qu * scale - d.dot(j.duu);
  m.b = j.du.head<2>().dot(j.dv.head<2>()) + qu * qv * scale - d.dot(j.duv);
  m.c = j.dv.head<2>().squaredNorm() + qv * qv * scale - d.dot(j.dvv);
  step.to = MinimizeOnBox(m, box);
  return step;
}

// True at a bound of [lo, hi] (which holds 0) if f falls beyond the bound.
bool PushesBack(double slope, double lo, double hi) {
  return (lo == 0.0 && slope > 0.0) || (hi == 0.0 && slope < 0.0);
}

// `definite`: concave and flat directions count as convex. If the ball nearly fits the surface, this gives
// small steps only. Without it the step ends at the border of the box.
Step NewtonStep(const State& s, const Box2& box, bool definite) {
  Step step;
  const SurfaceJet& j = s.jet;
  const Vec3& d = s.d;
  // First form as f measures it: without z above the centre.
  double e = j.du.squaredNorm(), f = j.du.dot(j.dv), g = j.dv.squaredNorm();
  const double tiny = 1e-14 * (e + g);
  if (!(d.z() > 0.0)) {
    e = std::max(j.du.head<2>().squaredNorm(), tiny);
    f = j.du.head<2>().dot(j.dv.head<2>());
    g = std::max(j.dv.head<2>().squaredNorm(), tiny);
  }
  Quadratic2& m = step.model;
  m.gx = -d.dot(j.du);
  m.gy = -d.dot(j.dv);
  m.a = e - d.dot(j.duu);
  m.b = f - d.dot(j.duv);
  m.c = g - d.dot(j.dvv);
  // A bound that pushes back holds its variable. A problem of one variable with its own curvature remains,
  // however concave the surface is across. The bound must still push back at the end of that step.
  const bool holds_u = PushesBack(m.gx, box.x0, box.x1), holds_v = PushesBack(m.gy, box.y0, box.y1);
  if (holds_u && holds_v) return step;
  if (definite && (holds_u || holds_v)) {
    if (holds_u) {
      step.exact = m.c > 1e-2 * g;
      const LineStep along = StepOnLine(m.c, g, m.gy, box.y0, box.y1);
      step.to.y = along.length;
      step.to.value = along.value;
    } else {
      step.exact = m.a > 1e-2 * e;
      const LineStep along = StepOnLine(m.a, e, m.gx, box.x0, box.x1);
      step.to.x = along.length;
      step.to.value = along.value;
    }
    if (holds_u ? PushesBack(m.gx + m.b * step.to.y, box.x0, box.x1)
                : PushesBack(m.gy + m.b * step.to.x, box.y0, box.y1)) {
      return step;
    }
    step.exact = false;
    step.to = {};
  }
  constexpr double kSmall = 1e-9;
  const double det = m.a * m.c - m.b * m.b;
  if (m.a > kSmall * e && m.c > kSmall * g && det > kSmall * e * g) {
    step.exact = det > 1e-2 * (e * g - f * f);
  } else if (definite) {
    MakeDefinite(e, f, g, tiny, m);
  }
  step.to = MinimizeOnBox(m, box);
  return step;
}

// Derivative of -f after the last step: that of the model at its minimum. It is zero except for active
// bounds.
Vec2 KktSlope(const Step& step, const Box2& box) {
  Vec2 slope;
  const double x = step.to.x, y = step.to.y;
  slope.x() = x > box.x0 && x < box.x1 ? 0.0 : -(step.model.gx + step.model.a * x + step.model.b * y);
  slope.y() = y > box.y0 && y < box.y1 ? 0.0 : -(step.model.gy + step.model.b * x + step.model.c * y);
  return slope;
}

}  // namespace

LocalJet LocalJetAt(const Rect& rect, double u, double v, const Vec3& d, const Vec2& slope) {
  const double lu = rect.u1 - rect.u0, lv = rect.v1 - rect.v0;
  return {(u - rect.u0) / lu - 0.5, (v - rect.v0) / lv - 0.5, 0.5 * d.squaredNorm(),
          Vec2(-lu * slope.x(), -lv * slope.y()), d.z()};
}

double LinearMinimum(double f, const Vec2& slope, const Rect& rect, double u, double v) {
  const double x = slope.x() > 0.0 ? rect.u1 - u : rect.u0 - u;
  const double y = slope.y() > 0.0 ? rect.v1 - v : rect.v0 - v;
  return f - slope.x() * x - slope.y() * y;
}

SearchResult RaiseOnPiece(const PiecePart& part, const Vec2& start, const Ball& ball,
                          const SearchOptions& options, Contact& best) {
  const Piece& piece = part.piece;
  const Rect& rect = part.rect;
  SearchResult result;
  State s{std::clamp(start.x(), rect.u0, rect.u1), std::clamp(start.y(), rect.v0, rect.v1), {}, {}, 0.0};
  const auto touch = [&](const Vec3& p, double at_u, double at_v) {
    const double g = TouchingHeight(p, ball);
    if (!(g > best.z)) return false;
    best = {g, part.index, at_u, at_v, p, Vec2::Constant(kNotKnown)};
    result.improved = true;
    return true;
  };

  s.jet = Evaluate(piece, s.u, s.v);
  touch(s.jet.p, s.u, s.v);
  Measure(ball, best.z, s);
  const auto end = [&] {
    if (result.improved) {
      result.u = best.u, result.v = best.v, result.p = best.p, result.slope = best.slope;
    } else {
      result.u = s.u, result.v = s.v, result.p = s.jet.p;
      result.slope = Vec2(s.d.dot(s.jet.du), s.d.dot(s.jet.dv));
    }
    result.f = s.f;
    return result;
  };
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const Box2 box{rect.u0 - s.u, rect.u1 - s.u, rect.v0 - s.v, rect.v1 - s.v};
    const bool touching = result.improved && best.u == s.u && best.v == s.v;
    const bool rise =
        touching && iteration >= kSlowIterations && iteration % 2 == 0 && s.d.z() > 1e-9 * ball.radius;
    const Step step = rise ? RiseStep(s, box) : NewtonStep(s, box, iteration < kSlowIterations);
    const double promise = -step.to.value;  // decrease of f

    const double gain = std::sqrt(s.d.z() * s.d.z() + 2.0 * std::max(0.0, promise)) - s.d.z();
    if (rise) {
      if (!(promise > 0.0)) continue;
    } else if (touching) {
      if (gain < kStopGain) {
        best.slope = KktSlope(step, box);
        break;
      }
      const double x = step.to.x, y = step.to.y;
      if (gain < kFinishGain && step.exact && std::max(std::abs(x), std::abs(y)) < kLastStep) {
        const SurfaceJet& j = s.jet;
        const Vec3 p = j.p + x * (j.du + 0.5 * x * j.duu + y * j.duv) + y * (j.dv + 0.5 * y * j.dvv);
        if (touch(p, std::clamp(s.u + x, rect.u0, rect.u1), std::clamp(s.v + y, rect.v0, rect.v1))) {
          best.slope = KktSlope(step, box);
          result.convex_minimum =
              LinearMinimum(0.5 * ball.radius * ball.radius, best.slope, rect, best.u, best.v);
          return end();
        }
        best.slope = KktSlope(step, box);
        break;
      }
    } else {
      if (options.lower != nullptr && !result.improved) {
        const Vec2 slope(s.d.dot(s.jet.du), s.d.dot(s.jet.dv));
        result.out = LeastFrom(*options.model, *options.lower, Lift(ball.q, best.z),
                               LocalJetAt(rect, s.u, s.v, s.d, slope)) >= ball.FreeF() ||
                     (options.lower->convex && LinearMinimum(s.f, slope, rect, s.u, s.v) >= ball.FreeF());
        if (result.out) return end();
      }
      if (!(promise > 1e-15 * (s.f + ball.radius * ball.radius))) break;
      if (iteration >= kSlowIterations && !result.improved && s.f - promise >= ball.FreeF()) break;
    }

    double t = 1.0;
    if (options.max_step < kInfinity) {
      const double length = (step.to.x * s.jet.du + step.to.y * s.jet.dv).norm();
      if (length > options.max_step) t = options.max_step / length;
    }
    State next = s;
    bool accepted = false;
    for (int k = 0; k < kMaxHalvings; ++k, t *= 0.5) {
      next.u = t == 1.0 && step.to.x == box.x1   ? rect.u1
               : t == 1.0 && step.to.x == box.x0 ? rect.u0
                                                 : std::clamp(s.u + t * step.to.x, rect.u0, rect.u1);
      next.v = t == 1.0 && step.to.y == box.y1   ? rect.v1
               : t == 1.0 && step.to.y == box.y0 ? rect.v0
                                                 : std::clamp(s.v + t * step.to.y, rect.v0, rect.v1);
      next.jet = Evaluate(piece, next.u, next.v);
      Measure(ball, best.z, next);
      if (next.f <= s.f - 1e-4 * t * promise ||
          (rise && TouchingHeight(next.jet.p, ball) >= best.z + 1e-4 * t * promise / s.d.z())) {
        accepted = true;
        break;
      }
    }
    if (!accepted && rise) continue;
    if (!accepted) break;
    s = next;
    if (touch(s.jet.p, s.u, s.v)) Measure(ball, best.z, s);
  }
  // The search has not finished. The slope is that at the last place.
  const Vec2 slope(s.d.dot(s.jet.du), s.d.dot(s.jet.dv));
  if (result.improved && best.u == s.u && best.v == s.v && std::isnan(best.slope.x())) best.slope = slope;
  result.convex_minimum = LinearMinimum(s.f, slope, rect, s.u, s.v);
  return end();
}

}  // namespace patchmill::internal
