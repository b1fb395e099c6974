#include "cam/location/local_search.h"

#include <algorithm>
#include <cmath>

namespace patchmill::internal {
namespace {

constexpr int kMaxIterations = 60;
constexpr int kMaxHalvings = 30;
// Stop when the model promises less (mm of height); the last step is then taken on the Taylor polynomial,
// whose error is of third order in a step of about 1e-4 mm.
constexpr double kFinishGain = 1e-9;
constexpr double kStopGain = 1e-13;

struct State {
  double u, v;
  SurfaceJet jet;
  Vec3 d;    // from the surface point to the ray
  double f;  // 1/2 |d|^2
};

// Height of the centre that touches p; -infinity when p is not under the ball.
double TouchingHeight(const Vec3& p, const Ball& ball) {
  const double dx = p.x() - ball.q.x(), dy = p.y() - ball.q.y();
  const double rim = ball.radius * ball.radius - (dx * dx + dy * dy);
  if (rim >= 0.0) return p.z() + std::sqrt(rim);
  return rim >= -2.0 * ball.radius * ball.slack ? p.z() : -kInfinity;
}

void Measure(const Ball& ball, double z, State& s) {
  s.d = ToRay(s.jet.p, Lift(ball.q, z));
  s.f = 0.5 * s.d.squaredNorm();
}

struct Step {
  Quadratic2 model;    // of f around the state
  bool exact = false;  // model holds the true Hessian and it is well conditioned
  BoxMinimum to;
};

Step NewtonStep(const State& s, const Box2& box) {
  Step step;
  const SurfaceJet& j = s.jet;
  const Vec3& d = s.d;
  const bool above = !(d.z() > 0.0);
  const double e = j.du.squaredNorm(), f = j.du.dot(j.dv), g = j.dv.squaredNorm();
  double ge = e, gf = f, gg = g;  // first form of what f measures: without z above the centre
  if (above) {
    ge -= j.du.z() * j.du.z();
    gf -= j.du.z() * j.dv.z();
    gg -= j.dv.z() * j.dv.z();
  }
  Quadratic2& m = step.model;
  m.gx = -d.dot(j.du);
  m.gy = -d.dot(j.dv);
  m.a = ge - d.dot(j.duu);
  m.b = gf - d.dot(j.duv);
  m.c = gg - d.dot(j.dvv);
  constexpr double kSmall = 1e-9;
  const double det = m.a * m.c - m.b * m.b;
  if (!(m.a > kSmall * e && m.c > kSmall * g && det > kSmall * e * g)) {
    const double tiny = 1e-14 * (e + g) + 1e-300;
    m.a = e + tiny;
    m.b = f;
    m.c = g + tiny;
  } else {
    step.exact = det > 1e-2 * (e * g - f * f);
  }
  step.to = MinimizeOnBox(m, box);
  return step;
}

// Derivative of -f after the last step: that of the model at its minimum, zero but for active bounds.
Vec2 KktSlope(const Step& step, const Box2& box) {
  Vec2 slope;
  const double x = step.to.x, y = step.to.y;
  slope.x() = x > box.x0 && x < box.x1 ? 0.0 : -(step.model.gx + step.model.a * x + step.model.b * y);
  slope.y() = y > box.y0 && y < box.y1 ? 0.0 : -(step.model.gy + step.model.b * x + step.model.c * y);
  return slope;
}

}  // namespace

double LinearMinimum(double f, const Vec2& slope, const Rect& rect, double u, double v) {
  const double x = slope.x() > 0.0 ? rect.u1 - u : rect.u0 - u;
  const double y = slope.y() > 0.0 ? rect.v1 - v : rect.v0 - v;
  return f - slope.x() * x - slope.y() * y;
}

SearchResult RaiseOnPiece(const Piece& piece, int piece_index, const Rect& rect, double u, double v,
                          const Ball& ball, const SearchOptions& options, Contact& best) {
  SearchResult result;
  State s{std::clamp(u, rect.u0, rect.u1), std::clamp(v, rect.v0, rect.v1), {}, {}, 0.0};
  const auto touch = [&](const Vec3& p, double at_u, double at_v) {
    const double g = TouchingHeight(p, ball);
    if (!(g > best.z)) return false;
    best = {g, piece_index, at_u, at_v, p, Vec2::Zero()};
    result.improved = true;
    return true;
  };

  s.jet = Evaluate(piece, s.u, s.v);
  touch(s.jet.p, s.u, s.v);
  Measure(ball, best.z, s);
  const auto end = [&] {
    if (result.improved) {
      result.u = best.u, result.v = best.v, result.p = best.p;
    } else {
      result.u = s.u, result.v = s.v, result.p = s.jet.p;
    }
    result.f = s.f;
    return result;
  };
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const Box2 box{rect.u0 - s.u, rect.u1 - s.u, rect.v0 - s.v, rect.v1 - s.v};
    const Step step = NewtonStep(s, box);
    const double promise = -step.to.value;  // decrease of f
    const bool touching = result.improved && best.u == s.u && best.v == s.v;

    const double gain = std::sqrt(s.d.z() * s.d.z() + 2.0 * std::max(0.0, promise)) - s.d.z();
    if (touching) {
      if (gain < kStopGain) {
        best.slope = KktSlope(step, box);
        break;
      }
      if (gain < kFinishGain && step.exact) {
        const double x = step.to.x, y = step.to.y;
        const SurfaceJet& j = s.jet;
        const Vec3 p = j.p + x * (j.du + 0.5 * x * j.duu + y * j.duv) + y * (j.dv + 0.5 * y * j.dvv);
        if (touch(p, std::clamp(s.u + x, rect.u0, rect.u1), std::clamp(s.v + y, rect.v0, rect.v1))) {
          best.slope = KktSlope(step, box);
          result.out_if_convex = true;
          return end();
        }
        best.slope = KktSlope(step, box);
        break;
      }
    } else {
      if (options.lower != nullptr && !result.improved && options.lower->convex) {
        if (LinearMinimum(s.f, Vec2(-step.model.gx, -step.model.gy), rect, s.u, s.v) >= ball.FreeF()) {
          result.out_if_convex = true;
          return end();
        }
      }
      if (!(promise > 1e-15 * (s.f + ball.radius * ball.radius))) break;
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
      if (next.f <= s.f - 1e-4 * t * promise) {
        accepted = true;
        break;
      }
    }
    if (!accepted) {
      if (touching) best.slope = Vec2(-step.model.gx, -step.model.gy);
      break;
    }
    s = next;
    if (touch(s.jet.p, s.u, s.v)) Measure(ball, best.z, s);
  }
  const Vec2 slope(s.d.dot(s.jet.du), s.d.dot(s.jet.dv));
  result.out_if_convex = LinearMinimum(s.f, slope, rect, s.u, s.v) >= ball.FreeF();
  return end();
}

}  // namespace patchmill::internal
