// One leaf against a group of lanes: first proofs, then Newton's method where the proofs leave something to
// find. The method is that of VisitLeaf and RaiseOnPiece without the line search. A lane that would need a
// line search, or whose leaf is not proven convex, is returned to them.
#pragma once

#include "cam/location/simd/lane_bounds.h"
#include "cam/location/simd/lane_jet.h"

namespace patchmill::internal::PM_LANES {

constexpr int kMaxLaneIterations = 8;
// The values are those in local_search.cc.
constexpr double kLaneFinishGain = 1e-9, kLaneStopGain = 1e-13, kLaneLastStep = 1e-3;

struct Group {
  D qx, qy, z, u, v, px, py, pz, slope_u, slope_v;
  M piece;
};

PM_LANE_INLINE Group LoadGroup(const LanePacket& p, int k) {
  return {Load(p.qx + k),      Load(p.qy + k),      Load(p.z + k),    Load(p.u + k),
          Load(p.v + k),       Load(p.px + k),      Load(p.py + k),   Load(p.pz + k),
          Load(p.slope_u + k), Load(p.slope_v + k), Load(p.piece + k)};
}

PM_LANE_INLINE void StoreContacts(const Group& g, LanePacket& p, int k) {
  Store(p.z + k, g.z);
  Store(p.u + k, g.u);
  Store(p.v + k, g.v);
  Store(p.px + k, g.px);
  Store(p.py + k, g.py);
  Store(p.pz + k, g.pz);
  Store(p.slope_u + k, g.slope_u);
  Store(p.slope_v + k, g.slope_v);
  Store(p.piece + k, g.piece);
}

// Height of the centre that touches p, valid where p is under the ball.
struct Touch {
  D z;
  M under;
};
PM_LANE_INLINE Touch TouchLanes(const Group& g, const LaneLimits& limits, const V3& p) {
  const D dx = p.x - g.qx, dy = p.y - g.qy;
  const D rim = limits.radius * limits.radius - (dx * dx + dy * dy);
  return {p.z + Sqrt(Max(rim, D{})), rim > 2.0 * limits.radius * limits.slack};
}

PM_LANE_INLINE D LinearMinimumLanes(D f, D slope_u, D slope_v, const Box& box) {
  const D x = slope_u > 0.0 ? box.x1 : box.x0, y = slope_v > 0.0 ? box.y1 : box.y0;
  return f - slope_u * x - slope_v * y;
}

// Writes a better contact into the lanes of `where` that touch higher than before. Its parameters are single
// vectors of lanes, because a struct of them would be built in memory in the innermost loop.
PM_LANE_INLINE M RaiseTo(const LaneLeaf& leaf, M where, const Touch& t, const V3& p, D u, D v, Group& g) {
  const M better = where & t.under & (t.z > g.z);
  const D not_known = Splat(__builtin_nan(""));
  g.z = better ? t.z : g.z;
  g.u = better ? u : g.u;
  g.v = better ? v : g.v;
  g.px = better ? p.x : g.px;
  g.py = better ? p.y : g.py;
  g.pz = better ? p.z : g.pz;
  g.slope_u = better ? not_known : g.slope_u;
  g.slope_v = better ? not_known : g.slope_v;
  g.piece = better ? SplatInt(leaf.piece) : g.piece;
  return better;
}

PM_LANE_INLINE M Grazes(const Group& g, const LaneLimits& limits) {
  return (g.piece >= 0) & (g.z - g.pz < limits.graze());
}

// Restores the lanes of `where` from `before`.
PM_LANE_INLINE void Restore(M where, const Group& before, Group& g) {
  g.z = where ? before.z : g.z;
  g.u = where ? before.u : g.u;
  g.v = where ? before.v : g.v;
  g.px = where ? before.px : g.px;
  g.py = where ? before.py : g.py;
  g.pz = where ? before.pz : g.pz;
  g.slope_u = where ? before.slope_u : g.slope_u;
  g.slope_v = where ? before.slope_v : g.slope_v;
  g.piece = where ? before.piece : g.piece;
}

// The value at (x, y) of a second-order expansion of one coordinate. Its parameters are single vectors of
// lanes, because the jet holds the coordinates in structs of their own.
PM_LANE_INLINE D Taylor(D x, D y, D p, D pu, D pv, D puu, D puv, D pvv) {
  return p + x * (pu + 0.5 * x * puu + y * puv) + y * (pv + 0.5 * y * pvv);
}

// How a search ended, by lane. `arrived`: at a local maximum. `out`: nothing in reach, on a rectangle where f
// is convex. Neither: it gave up.
struct Ended {
  M arrived, out;
};

// Newton's method from (u, v) on the lanes of `run`, within the rectangle of `leaf`. Place and lanes are
// parameters of their own, because each is a vector of lanes that stays in registers.
PM_LANE_INLINE Ended RaiseLanes(const LaneLeaf& leaf, const LaneLimits& limits, D u, D v, M run, Group& g) {
  const D u0 = Splat(leaf.u0), u1 = Splat(leaf.u1), v0 = Splat(leaf.v0), v1 = Splat(leaf.v1);
  M improved{}, out{}, arrived{};
  D last_f{}, last_promise{};
  for (int iteration = 0; iteration < kMaxLaneIterations && Any(run); ++iteration) {
    Jet j;
    EvaluateLanes(leaf.net, u, v, j);
    D dz = Max(g.z - j.p.z, D{});
    const D dx = g.qx - j.p.x, dy = g.qy - j.p.y, plan2 = dx * dx + dy * dy;
    if (iteration > 0) run &= 0.5 * (plan2 + dz * dz) <= last_f - 1e-4 * last_promise;
    const Touch touch = TouchLanes(g, limits, j.p);
    improved |= RaiseTo(leaf, run, touch, j.p, u, v, g);
    const M touching = run & improved & touch.under & (touch.z >= g.z - limits.slack);
    dz = Max(g.z - j.p.z, D{});
    const V3 d{dx, dy, dz};
    const D f = 0.5 * (plan2 + dz * dz);

    // The model of f. Above the centre, f measures horizontally.
    D e = Dot(j.du, j.du), ef = Dot(j.du, j.dv), eg = Dot(j.dv, j.dv);
    const M above = ~(dz > 0.0);
    if (Any(run & above)) {
      e = above ? DotXy(j.du, j.du) : e;
      ef = above ? DotXy(j.du, j.dv) : ef;
      eg = above ? DotXy(j.dv, j.dv) : eg;
    }
    const Quadratic m{e - Dot(d, j.duu), ef - Dot(d, j.duv), eg - Dot(d, j.dvv), -Dot(d, j.du),
                      -Dot(d, j.dv)};
    const Box box{u0 - u, u1 - u, v0 - v, v1 - v};
    const D det = m.a * m.c - m.b * m.b, least = LinearMinimumLanes(f, -m.gx, -m.gy, box);
    const M lost = run & ~improved & (least >= limits.free_f);
    out |= lost;
    run &= ~lost & (m.a > 1e-9 * e) & (m.c > 1e-9 * eg) & (det > 1e-9 * (e * eg));
    if (!Any(run)) break;
    const Minimum to = MinimizeOnBoxLanes(m, box, run);
    const D promise = -to.value, gain = Sqrt(dz * dz + 2.0 * Max(promise, D{})) - dz;

    const M exact = (gain < kLaneFinishGain) & (det > 1e-2 * (e * eg - ef * ef)) &
                    (Max(Abs(to.x), Abs(to.y)) < kLaneLastStep);
    const M finish = run & touching & (exact | (gain < kLaneStopGain));
    if (Any(finish)) {
      const D x = to.x, y = to.y;
      const V3 p{Taylor(x, y, j.p.x, j.du.x, j.dv.x, j.duu.x, j.duv.x, j.dvv.x),
                 Taylor(x, y, j.p.y, j.du.y, j.dv.y, j.duu.y, j.duv.y, j.dvv.y),
                 Taylor(x, y, j.p.z, j.du.z, j.dv.z, j.duu.z, j.duv.z, j.dvv.z)};
      RaiseTo(leaf, finish & exact, TouchLanes(g, limits, p), p, Clamp(u + x, u0, u1), Clamp(v + y, v0, v1),
              g);
      const D slope_u = -(m.gx + m.a * x + m.b * y), slope_v = -(m.gy + m.b * x + m.c * y);
      const M free_u = (x > box.x0) & (x < box.x1), free_v = (y > box.y0) & (y < box.y1);
      g.slope_u = finish ? (free_u ? D{} : slope_u) : g.slope_u;
      g.slope_v = finish ? (free_v ? D{} : slope_v) : g.slope_v;
      arrived |= finish;
      run &= ~finish;
    }
    u = to.x >= box.x1 ? u1 : to.x <= box.x0 ? u0 : Clamp(u + to.x, u0, u1);
    v = to.y >= box.y1 ? v1 : to.y <= box.y0 ? v0 : Clamp(v + to.y, v0, v1);
    last_f = f;
    last_promise = promise;
  }
  return {arrived, out};
}

// The search on the lanes of `todo`, where f is convex at the first height. Returns the lanes that are not
// resolved, which stay unchanged.
PM_LANE_INLINE M SearchLeaf(const LaneLeaf& leaf, const LaneLimits& limits, M todo, Group& g) {
  const Minimum guess = GuessMinimumLanes(leaf, {g.qx, g.qy, g.z}, todo);
  const D u0 = Splat(leaf.u0), u1 = Splat(leaf.u1), v0 = Splat(leaf.v0), v1 = Splat(leaf.v1);
  const D u = Clamp(u0 + (0.5 + guess.x) * (u1 - u0), u0, u1);
  const D v = Clamp(v0 + (0.5 + guess.y) * (v1 - v0), v0, v1);
  const Group before = g;
  Ended end = RaiseLanes(leaf, limits, u, v, todo, g);
  // If f is proven convex at the final height, there is one maximum, and the search has found it.
  if (Any(end.arrived)) end.arrived &= BoundBelowLanes(leaf, {g.qx, g.qy, g.z}).convex;
  end.arrived &= ~Grazes(g, limits);
  todo &= ~(end.out | end.arrived);
  if (Any(todo)) Restore(todo, before, g);
  return todo;
}

PM_LANE_INLINE M Holds(const LaneLeaf& leaf, const Group& g) {
  const M inside = (g.u >= leaf.u0) & (g.u <= leaf.u1) & (g.v >= leaf.v0) & (g.v <= leaf.v1);
  const M kkt_u = ((g.slope_u <= 0.0) | (g.u == leaf.u1)) & ((g.slope_u >= 0.0) | (g.u == leaf.u0));
  const M kkt_v = ((g.slope_v <= 0.0) | (g.v == leaf.v1)) & ((g.slope_v >= 0.0) | (g.v == leaf.v0));
  return (g.piece == leaf.piece) & inside & kkt_u & kkt_v;
}

// Returns the lanes that are not resolved.
PM_LANE_INLINE unsigned VisitGroup(const LaneLeaf& leaf, const LaneLimits& limits, LanePacket& packet,
                                   int first) {
  Group g = LoadGroup(packet, first);
  const V3 c{g.qx, g.qy, g.z};
  M active = ~BoxOutsideLanes(leaf, c, Splat(2.0 * limits.free_f));
  if (!Any(active)) return 0;
  const Lower low = BoundBelowLanes(leaf, c);
  active &= ~(low.convex & Holds(leaf, g));
  if (Any(active & low.minorant)) {
    const D half = Splat(0.5);
    const Minimum min = MinimizeOnBoxLanes(low.q, {-half, half, -half, half}, active & low.minorant);
    active &= ~(low.minorant & (low.f0 + min.value >= limits.free_f));
  }
  if (!Any(active)) return 0;
  M todo = active & low.convex;
  if (leaf.net.known && Any(todo)) {
    todo = SearchLeaf(leaf, limits, todo, g);
    StoreContacts(g, packet, first);
  }
  return Bits((active & ~low.convex) | todo);
}

inline unsigned VisitLeafLanes(const LaneLeaf& leaf, const LaneLimits& limits, LanePacket& packet) {
  unsigned unresolved = 0;
  for (int first = 0; first < kLanes; first += kWidth) {
    unresolved |= VisitGroup(leaf, limits, packet, first) << first;
  }
  return unresolved;
}

inline unsigned MeetsLanes(const LaneLeaf& leaf, const LaneLimits& limits, const LanePacket& packet) {
  unsigned meeting = 0;
  for (int k = 0; k < kLanes; k += kWidth) {
    const V3 c{Load(packet.qx + k), Load(packet.qy + k), Load(packet.z + k)};
    meeting |= Bits(~BoxOutsideLanes(leaf, c, Splat(2.0 * limits.free_f))) << k;
  }
  return meeting;
}

inline void ApproachLanes(const LaneLeaf& piece, const LaneLimits& limits, const LaneStart& start,
                          LanePacket& packet) {
  for (int first = 0; first < kLanes; first += kWidth) {
    const M wanted = Load(start.piece + first) == SplatInt(piece.piece);
    if (!Any(wanted)) continue;
    Group g = LoadGroup(packet, first);
    const Group before = g;
    const D zero{}, one = Splat(1.0);
    RaiseLanes(piece, limits, Clamp(Load(start.u + first), zero, one),
               Clamp(Load(start.v + first), zero, one), wanted, g);
    Restore(wanted & Grazes(g, limits), before, g);
    StoreContacts(g, packet, first);
  }
}

}  // namespace patchmill::internal::PM_LANES
