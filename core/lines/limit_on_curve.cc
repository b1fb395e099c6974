#include "core/lines/limit_on_curve.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/lines/zero_root.h"

namespace patchmill {
namespace {

constexpr double kStep = 1e-6, kDone = 1e-12;  // in parameters
constexpr double kFirst = 1e-3;                // share of the reach

// How far the piece extends from q in the direction `way` of length 1; `most` at most.
double Room(const Vec2& q, const Vec2& way, double most) {
  for (int c = 0; c < 2; ++c) {
    if (way[c] > 0.0) most = std::min(most, (1.0 - q[c]) / way[c]);
    if (way[c] < 0.0) most = std::min(most, -q[c] / way[c]);
  }
  return std::max(0.0, most);
}

bool Within(const Vec2& q) { return q.minCoeff() >= 0.0 && q.maxCoeff() <= 1.0; }

Vec2 Gradient(const ZeroField& field, const Piece& piece, const Vec2& q, double at) {
  const double hu = q.x() < 0.5 ? kStep : -kStep, hv = q.y() < 0.5 ? kStep : -kStep;
  return {(Value(field, piece, q + Vec2(hu, 0.0)) - at) / hu,
          (Value(field, piece, q + Vec2(0.0, hv)) - at) / hv};
}

struct OnCurve {
  Vec2 q, along;  // `along` has length 1
};

// Newton's method across the curve, within `reach` of the start.
std::optional<OnCurve> Project(const ZeroField& curve, const Piece& piece, Vec2 q, double reach) {
  const Vec2 start = q;
  for (int i = 0; i < 12; ++i) {
    const double at = Value(curve, piece, q);
    const Vec2 gradient = Gradient(curve, piece, q, at);
    const double squared = gradient.squaredNorm();
    if (!(squared > 0.0)) return std::nullopt;
    const Vec2 step = -at / squared * gradient;
    q += step;
    if (!Within(q) || !((q - start).norm() <= reach)) return std::nullopt;
    if (step.norm() < kDone) return OnCurve{q, Vec2(-gradient.y(), gradient.x()) / std::sqrt(squared)};
  }
  return std::nullopt;
}

}  // namespace

std::optional<Vec2> LimitOnCurve(const ZeroField& curve, const ZeroField& limit, const Piece& piece,
                                 const Vec2& place, double reach) {
  std::optional<OnCurve> at = Project(curve, piece, place, reach);
  // Finds the limit along the tangent, then returns to the curve from there. Each round comes much nearer.
  bool found = false;
  for (double half = kFirst * reach; at && half > kDone;) {
    if (!(half <= reach)) return std::nullopt;
    const Vec2 &q = at->q, &along = at->along;
    ZeroSegment tangent{q - Room(q, -along, half) * along, q + Room(q, along, half) * along};
    const double from = Value(limit, piece, tangent.from), to = Value(limit, piece, tangent.to);
    if (!(from * to < 0.0)) {
      if (found) break;  // nearer than signs can show
      half *= 4.0;
      continue;
    }
    if (from > 0.0) std::swap(tangent.from, tangent.to);
    double share = 0.5;
    limit.limits(piece, {&tangent, 1}, {&share, 1});
    const Vec2 off = tangent.from + share * (tangent.to - tangent.from);
    at = Project(curve, piece, off, reach);
    if (at) half = std::min(0.25 * half, 4.0 * (at->q - off).norm());
    found = true;
  }
  if (!at || !found || !((at->q - place).norm() <= reach)) return std::nullopt;
  return at->q;
}

}  // namespace patchmill
