#include "cam/path/reach/cell_reach.h"

#include <algorithm>
#include <cmath>

#include "cam/location/ray_distance.h"
#include "cam/path/edge/sheet_border.h"
#include "core/diffgeo/forms.h"
#include "core/surface/closest.h"

namespace patchmill {
namespace {

constexpr double kMostTurn = 0.7;  // rad, about: largest turn of a normal from the middle one

}  // namespace

std::array<Vec2, 9> NineParameters(const SurfaceRect& rect) {
  const double um = 0.5 * (rect.u0 + rect.u1), vm = 0.5 * (rect.v0 + rect.v1);
  return {{Vec2(rect.u0, rect.v0), Vec2(rect.u1, rect.v0), Vec2(rect.u0, rect.v1), Vec2(rect.u1, rect.v1),
           Vec2(um, rect.v0), Vec2(um, rect.v1), Vec2(rect.u0, vm), Vec2(rect.u1, vm), Vec2(um, vm)}};
}

std::optional<RectPlaces> PlacesOn(const Surface& surface, const SurfaceRect& rect, double size) {
  const auto uv = NineParameters(rect);
  RectPlaces at;
  at.size = size;
  for (std::size_t k = 9; k-- > 0;) {
    const SurfaceJet jet = Evaluate(surface, rect.piece, uv[k].x(), uv[k].y());
    const auto normal = UnitNormal(jet);
    at.p[k] = jet.p;
    at.sides = jet.sides;
    at.n[k] = normal ? *normal : UpwardNormalNear(surface, {rect.piece, uv[k].x(), uv[k].y(), jet.p});
    if (!normal && at.n[k].dot(at.n[8]) < 0.0) at.n[k] = -at.n[k];
    if ((at.n[k] - at.n[8]).norm() > kMostTurn) return std::nullopt;
  }
  return at;
}

double BendOver(const std::array<Vec3, 9>& f) {
  const double off =
      std::max({(f[4] - 0.5 * (f[0] + f[1])).squaredNorm(), (f[5] - 0.5 * (f[2] + f[3])).squaredNorm(),
                (f[6] - 0.5 * (f[0] + f[2])).squaredNorm(), (f[7] - 0.5 * (f[1] + f[3])).squaredNorm(),
                (f[8] - 0.25 * (f[0] + f[1] + f[2] + f[3])).squaredNorm()});
  return 2.0 * std::sqrt(off);
}

bool TooBent(const std::array<Vec3, 9>& f, double size) {
  // Part of the extent.
  constexpr double kMostBend = 0.25;
  const double extent = std::max({size, (f[3] - f[0]).norm(), (f[2] - f[1]).norm()});
  return BendOver(f) > kMostBend * extent;
}

bool OutOfReach(const Surface& surface, const RectPlaces& at, const CellReachParams& params,
                Blockers& blockers, const SidesRuledOut& ruled_out) {
  const double limit = params.radius - params.reach_tolerance;
  const double turn = BendOver(at.n);
  for (std::size_t side = 0; side < 2; ++side) {
    if (ruled_out[side]) continue;
    const double sign = side == 0 ? 1.0 : -1.0;
    double highest_normal = -1.0, lowest_normal = 1.0, highest_center = -kInfinity;
    std::array<Vec3, 9> c;
    for (std::size_t k = 0; k < 9; ++k) {
      c[k] = at.p[k] + sign * params.radius * at.n[k];
      highest_normal = std::max(highest_normal, sign * at.n[k].z());
      lowest_normal = std::min(lowest_normal, sign * at.n[k].z());
      highest_center = std::max(highest_center, c[k].z());
    }
    if (at.sides.RulesOut(sign, highest_normal + turn)) continue;
    // The side looks down but for a strip of this share of the diameter.
    const double up = highest_normal + turn + at.sides.upright;
    if (!at.sides.overhangs && up * at.size < params.narrow * (highest_normal - lowest_normal)) continue;
    const double bend = BendOver(c);
    if (TooBent(c, at.size)) return false;
    if (highest_center + bend < params.floor_z - params.reach_tolerance) continue;
    const auto farthest = [&](const SurfacePoint& q) {
      double most = 0.0;
      for (std::size_t k = 0; k < 4; ++k) most = std::max(most, internal::ToRay(q.p, c[k]).norm());
      return most + bend;
    };
    std::optional<SurfacePoint>& known = blockers[side];
    if (known && farthest(*known) < limit) continue;
    // The farther apart the centres lie, the less exactly the deepest point need be known.
    const double exact = std::clamp(0.05 * at.size, 1e-5, 0.02 * params.radius);
    const auto blocked = [&](double tolerance) {
      const auto deepest = ClosestToUpwardRay(surface, c[8], limit, tolerance);
      if (deepest) known = deepest->at;
      return deepest && farthest(*known) < limit;
    };
    if (blocked(exact)) continue;
    if (!(params.proof > 0.0 && params.proof < exact && blocked(params.proof))) return false;
  }
  return true;
}

}  // namespace patchmill
