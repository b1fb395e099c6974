#include "core/lines/flow_step.h"

#include <algorithm>
#include <cmath>

#include "core/diffgeo/forms.h"
#include "core/diffgeo/principal_directions.h"
#include "core/surface/closest.h"

namespace patchmill {
namespace {

constexpr double kFlat = 1e-6;         // length of the gradient
constexpr double kLeastGrowth = 0.3;   // of the function over a step, as a share of the predicted growth
constexpr double kOnBorder = 1e-9;     // in parameters of a piece
constexpr double kStray = 1e-12;       // in parameters of a piece; rounding
constexpr double kMostTurn = 0.3;      // rad, of a line of curvature over a step
constexpr double kLeastAlign = 0.866;  // cosine of the largest jump of a line of curvature between pieces

// The derivatives that FlowGradient needs.
SurfaceJet JetFor(const Surface& surface, const FlowParams& params, PieceId piece, const Vec2& q) {
  const Piece& on = surface.piece(piece);
  return params.kind == FlowKind::kAlongHeight ? EvaluateSlopes(on, q.x(), q.y())
                                               : Evaluate(on, q.x(), q.y());
}

// The principal direction nearest to flow.heading. Zero at umbilics and where there is no normal.
Vec3 PrincipalNear(const Flow& flow, const SurfaceJet& jet) {
  const auto normal = UnitNormal(jet);
  if (!normal) return Vec3::Zero();
  const FundamentalForms forms = Forms(jet, *normal);
  const PrincipalCurvatures k = Principal(forms);
  const double mean = 0.5 * std::abs(k.k_min + k.k_max);
  const double least = std::max(kUmbilic * mean, kLeastBend / flow.params.spacing);
  if (!(0.5 * (k.k_max - k.k_min) > least)) return Vec3::Zero();
  const auto directions = DirectionsOf(jet, forms);
  if (!directions) return Vec3::Zero();
  const double along_min = directions->min.dot(flow.heading), along_max = directions->max.dot(flow.heading);
  if (std::abs(along_max) > std::abs(along_min)) return along_max < 0.0 ? -directions->max : directions->max;
  return along_min < 0.0 ? -directions->min : directions->min;
}

// The unit tangent of the flow. Zero where it has no direction.
Vec3 Direction(const Flow& flow, const SurfaceJet& jet) {
  const FlowParams& params = flow.params;
  if (params.kind == FlowKind::kAlongCurvature) return PrincipalNear(flow, jet);
  const Vec3 g = FlowGradient(jet, params);
  const double flat = params.kind == FlowKind::kAlongHeight ? kFlat : kFlat / params.spacing;
  const double size = g.norm();
  return size > flat ? Vec3((flow.sign / size) * g) : Vec3::Zero();
}

// The velocity in parameters for unit speed in space. Zero where the flow has no direction.
Vec2 Velocity(const Flow& flow, PieceId piece, const Vec2& q) {
  const SurfaceJet jet = JetFor(flow.surface, flow.params, piece, q);
  const Vec3 t = Direction(flow, jet);
  if (t.isZero()) return Vec2::Zero();
  const double e = jet.du.squaredNorm(), f = jet.du.dot(jet.dv), h = jet.dv.squaredNorm();
  const double w = e * h - f * f, a = t.dot(jet.du), b = t.dot(jet.dv);
  return {(a * h - b * f) / w, (b * e - a * f) / w};
}

Vec2 Clamped(const Vec2& q) { return q.cwiseMax(0.0).cwiseMin(1.0); }

// The classical Runge-Kutta step of length h. nullopt if the flow has no direction on the way. Stages may lie
// a little beyond the piece; they are moved to its border.
std::optional<Vec2> RungeKutta(const Flow& flow, PieceId piece, const Vec2& q, double h) {
  const auto slope = [&](const Vec2& x) { return Velocity(flow, piece, Clamped(x)); };
  const Vec2 k1 = slope(q);
  const Vec2 k2 = slope(q + 0.5 * h * k1), k3 = slope(q + 0.5 * h * k2), k4 = slope(q + h * k3);
  for (const Vec2& k : {k1, k2, k3, k4}) {
    if (k.isZero()) return std::nullopt;
  }
  return q + (h / 6.0) * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
}

// A flow along a border may leave it by rounding.
bool Inside(const Vec2& q) { return q.minCoeff() >= -kStray && q.maxCoeff() <= 1.0 + kStray; }

// The longest step that stays inside, found by halving.
double StepToBorder(const Flow& flow, PieceId piece, const Vec2& q, double h) {
  double low = 0.0, high = h;
  for (int i = 0; i < 50 && high - low > 1e-13 * h; ++i) {
    const double middle = 0.5 * (low + high);
    const auto there = RungeKutta(flow, piece, q, middle);
    (there && Inside(*there) ? low : high) = middle;
  }
  return low;
}

}  // namespace

Vec3 FlowGradient(const SurfaceJet& jet, const FlowParams& params) {
  const auto normal = UnitNormal(jet);
  if (!normal) return Vec3::Zero();
  const FundamentalForms f = Forms(jet, *normal);
  const double w = f.E * f.G - f.F * f.F;
  double fu = params.axis.dot(jet.du), fv = params.axis.dot(jet.dv);
  if (params.kind == FlowKind::kAlongSlope) {
    // [lines (5)]: psi_u = alpha phi_u + beta phi_v, and alike for v, on the side that faces along the axis.
    const double side = params.axis.dot(*normal) < 0.0 ? -1.0 : 1.0;
    const double pu = fu, pv = fv;
    fu = side * ((f.M * f.F - f.L * f.G) * pu + (f.L * f.F - f.M * f.E) * pv) / w;
    fv = side * ((f.N * f.F - f.M * f.G) * pu + (f.M * f.F - f.N * f.E) * pv) / w;
  }
  return ((fu * f.G - fv * f.F) * jet.du + (fv * f.E - fu * f.F) * jet.dv) / w;
}

std::optional<FlowPlace> PlaceOn(const Flow& flow, PieceId piece, double u, double v) {
  const FlowParams& params = flow.params;
  const SurfaceJet jet = JetFor(flow.surface, params, piece, {u, v});
  const auto normal = UnitNormal(jet);
  const Vec2 velocity = Velocity(flow, piece, {u, v});
  if (!normal || velocity.isZero()) return std::nullopt;
  FlowPlace place;
  place.at = {piece, u, v, jet.p};
  place.tangent = (velocity.x() * jet.du + velocity.y() * jet.dv).normalized();
  place.normal = *normal;
  if (params.kind == FlowKind::kAlongCurvature) {
    const FundamentalForms forms = Forms(jet, *normal);
    const double mean = 0.5 * (Principal(forms).k_min + Principal(forms).k_max);
    place.of_max = NormalCurvature(forms, jet, place.tangent) > mean;
    return place;
  }
  place.value =
      params.kind == FlowKind::kAlongHeight ? params.axis.dot(jet.p) : std::abs(params.axis.dot(*normal));
  place.gradient = FlowGradient(jet, params).norm();
  return place;
}

std::optional<FlowStep> Advance(const Flow& along, const FlowPlace& from, double* length) {
  const Flow flow{along.surface, along.params, along.sign, from.tangent};
  const FlowParams& params = flow.params;
  const bool grows = params.kind != FlowKind::kAlongCurvature;
  const PieceId piece = from.at.piece;
  const Vec2 q(from.at.u, from.at.v);
  const double shortest = 1e-4 * params.spacing;
  double h = *length;
  for (;; h *= 0.5) {
    if (h < shortest) return std::nullopt;
    const auto whole = RungeKutta(flow, piece, q, h);
    if (!whole) continue;
    FlowStep step;
    Vec2 end = Clamped(*whole);
    if (!Inside(*whole)) {
      h = StepToBorder(flow, piece, q, h);
      const auto cut = RungeKutta(flow, piece, q, h);
      end = Clamped(cut ? *cut : q);
      step.at_border = true;
    }
    const auto place = PlaceOn(flow, piece, end.x(), end.y());
    if (!place) {
      if (step.at_border) return std::nullopt;
      continue;
    }
    // Two half steps show the error of the whole step. The turn shows how far the chord lies beside the line.
    const double turn = (place->tangent - from.tangent).norm();
    double error = h * turn / 8.0;
    if (const auto half = RungeKutta(flow, piece, q, 0.5 * h)) {
      if (const auto two = RungeKutta(flow, piece, *half, 0.5 * h)) {
        const Vec2 there = Clamped(*two);
        error = std::max(
            error, 10.0 * (Position(flow.surface.piece(piece), there.x(), there.y()) - place->at.p).norm());
      }
    }
    // Around a summit or a pit, long steps would jump back and forth.
    const double grown = flow.sign * (place->value - from.value);
    const bool steady =
        grows ? grown > kLeastGrowth * h * from.gradient : turn <= kMostTurn && place->of_max == from.of_max;
    const bool sound = error <= params.tolerance && steady;
    if (!sound && h > shortest) {
      step.at_border = false;
      continue;
    }
    if (place->tangent.dot(from.tangent) <= 0.0) return std::nullopt;  // turned back: a singular line
    step.place = *place;
    *length = error < 0.1 * params.tolerance ? 2.0 * h : h;
    *length = std::clamp(*length, 2.0 * shortest, 0.4 * params.spacing);
    return step;
  }
}

std::optional<FlowPlace> CrossBorder(const Flow& along, const FlowPlace& from) {
  const Flow flow{along.surface, along.params, along.sign, from.tangent};
  const Surface& surface = flow.surface;
  const bool curvature = flow.params.kind == FlowKind::kAlongCurvature;
  const double least_align = curvature ? kLeastAlign : 0.0;
  const double along_border = curvature ? kOnBorder : 0.0;  // what counts as a line along the border
  // Finds the surface a little beyond the border, if there is any.
  const double beyond = std::max(1e-3 * flow.params.spacing, 2.0 * surface.network.join_tolerance);
  const auto enter = [&](const Vec3& p) -> std::optional<FlowPlace> {
    const auto next = ClosestToPoint(surface, p, 0.1 * beyond, 0.01 * beyond);
    if (!next) return std::nullopt;
    const auto place = PlaceOn(flow, next->at.piece, next->at.u, next->at.v);
    if (!place || place->tangent.dot(from.tangent) <= least_align) return std::nullopt;
    // The point lies on a border again, and the flow leaves there: the surface ends here, at a slant.
    const Vec2 q(next->at.u, next->at.v), to = Velocity(flow, next->at.piece, q);
    for (int k = 0; k < 2; ++k) {
      const double out_of = q[k] <= kOnBorder ? -to[k] : q[k] >= 1.0 - kOnBorder ? to[k] : 0.0;
      if (out_of > along_border * to.norm()) return std::nullopt;
    }
    return place;
  };
  const Vec3 ahead = from.at.p + beyond * from.tangent;
  if (const auto place = enter(ahead)) return place;
  // A flow along the seam may leave it by rounding. Then it continues on the other side of the seam.
  const SurfaceJet jet = Evaluate(surface, from.at.piece, from.at.u, from.at.v);
  Vec3 out = Vec3::Zero();
  if (from.at.u <= kOnBorder || from.at.u >= 1.0 - kOnBorder) out += (from.at.u < 0.5 ? -jet.du : jet.du);
  if (from.at.v <= kOnBorder || from.at.v >= 1.0 - kOnBorder) out += (from.at.v < 0.5 ? -jet.dv : jet.dv);
  out -= out.dot(from.tangent) * from.tangent;
  if (!(out.norm() > 0.0)) return std::nullopt;
  return enter(ahead + 0.1 * beyond * out.normalized());
}

}  // namespace patchmill
