// The proofs of ray_distance.h, box_qp.h and leaf_model.h, with one ball per lane.
#pragma once

#include "cam/location/simd/lane_types.h"

namespace patchmill::internal::PM_LANES {

// As OrientedBoxOutside.
PM_LANE_INLINE M BoxOutsideLanes(const LaneLeaf& leaf, const V3& c, D limit2) {
  const V3 m{c.x - leaf.center[0], c.y - leaf.center[1], c.z - leaf.center[2]};
  V3 out = Zero3();
  D distance2{};
  for (int k = 0; k < 3; ++k) {
    const double* axis = leaf.axis + 3 * k;
    const D y = Dot(m, axis), e = Abs(y) - leaf.half[k], past = Max(e, D{});
    distance2 += past * past;
    AddTimes(out, y < 0.0 ? -past : past, axis);
  }
  const M away = distance2 >= limit2;
  M outside = away & (out.z >= 0.0);
  const M below = away & (out.z < 0.0);
  if (!Any(below)) return outside;
  const D length2 = out.x * out.x + out.y * out.y;
  D gap = out.x * m.x + out.y * m.y;
  for (int k = 0; k < 3; ++k) {
    gap -= leaf.half[k] * Abs(out.x * leaf.axis[3 * k] + out.y * leaf.axis[3 * k + 1]);
  }
  return outside | (below & (length2 > 0.0) & (gap > 0.0) & (gap * gap >= limit2 * length2));
}

struct Quadratic {
  D a, b, c, gx, gy;
  PM_LANE_INLINE D At(D x, D y) const { return x * (0.5 * a * x + b * y + gx) + y * (0.5 * c * y + gy); }
};
struct Box {
  D x0, x1, y0, y1;
};
struct Minimum {
  D x, y, value;
};

PM_LANE_INLINE D MinimumOnSegmentLanes(D a, D g, D lo, D hi) {
  const D end = lo * (0.5 * a * lo + g) <= hi * (0.5 * a * hi + g) ? lo : hi;
  return a > 0.0 ? Clamp(-g / a, lo, hi) : end;
}

// As MinimizeOnBox. Only the lanes of `wanted` are valid.
PM_LANE_INLINE Minimum MinimizeOnBoxLanes(const Quadratic& f, const Box& box, M wanted) {
  const D det = f.a * f.c - f.b * f.b;
  const D x = (f.b * f.gy - f.c * f.gx) / det, y = (f.b * f.gx - f.a * f.gy) / det;
  const M inside = (det > 0.0) & (f.a > 0.0) & (x >= box.x0) & (x <= box.x1) & (y >= box.y0) & (y <= box.y1);
  Minimum best{x, y, f.At(x, y)};
  if (!Any(wanted & ~inside)) return best;
  Minimum edge{box.x0, MinimumOnSegmentLanes(f.c, f.b * box.x0 + f.gy, box.y0, box.y1), D{}};
  edge.value = f.At(edge.x, edge.y);
  const auto take = [&](D tx, D ty) __attribute__((always_inline)) {
    const D value = f.At(tx, ty);
    const M better = value < edge.value;
    edge.x = better ? tx : edge.x;
    edge.y = better ? ty : edge.y;
    edge.value = better ? value : edge.value;
  };
  take(box.x1, MinimumOnSegmentLanes(f.c, f.b * box.x1 + f.gy, box.y0, box.y1));
  take(MinimumOnSegmentLanes(f.a, f.b * box.y0 + f.gx, box.x0, box.x1), box.y0);
  take(MinimumOnSegmentLanes(f.a, f.b * box.y1 + f.gx, box.x0, box.x1), box.y1);
  best.x = inside ? best.x : edge.x;
  best.y = inside ? best.y : edge.y;
  best.value = inside ? best.value : edge.value;
  return best;
}

PM_LANE_INLINE double Dot3(const double* a, const double* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// As LowerModel.
struct Lower {
  Quadratic q;
  D f0;
  M convex, minorant;
};

PM_LANE_INLINE Lower BoundBelowLanes(const LaneLeaf& leaf, const V3& c) {
  const LeafErrors& m = *leaf.errors;
  const double *a = leaf.a, *b = leaf.b;
  const double gram_uu = m.gram_uu, gram_uv = m.gram_uv, gram_vv = m.gram_vv, drift_uu = m.drift_uu,
               drift_uv = m.drift_uv, drift_vv = m.drift_vv, drift_a = m.drift_a, drift_b = m.drift_b,
               reach = m.reach, z_max = m.z_max;
  Lower low;
  const V3 d{leaf.s[0] - c.x, leaf.s[1] - c.y, leaf.s[2] - c.z};
  const D distance2 = Dot(d, d), size = Sqrt(distance2) + reach;
  const D e_uu = gram_uu + size * drift_uu, e_uv = gram_uv + size * drift_uv,
          e_vv = gram_vv + size * drift_vv;
  low.f0 = 0.5 * distance2 - m.rest * size;
  low.q.a = Dot3(a, a) + Dot(d, leaf.uu) - e_uu - e_uv;
  low.q.b = Dot3(a, b) + Dot(d, leaf.uv);
  low.q.c = Dot3(b, b) + Dot(d, leaf.vv) - e_vv - e_uv;
  low.q.gx = Dot(d, a);
  low.q.gy = Dot(d, b);
  low.convex = (low.q.a > 0.0) & (low.q.c > 0.0) & (low.q.a * low.q.c > low.q.b * low.q.b);
  low.minorant = z_max <= c.z;
  const M rising = low.convex & ~low.minorant;
  if (!Any(rising)) return low;

  const double az = a[2] < 0.0 ? -a[2] : a[2], bz = b[2] < 0.0 ? -b[2] : b[2];
  const auto abs = [](double x) __attribute__((always_inline)) { return x < 0.0 ? -x : x; };
  const D rise = Abs(d.z) + reach;
  const D h_uu = e_uu + (2.0 * az * drift_a + drift_a * drift_a + reach * abs(leaf.uu[2])) + rise * drift_uu;
  const D h_vv = e_vv + (2.0 * bz * drift_b + drift_b * drift_b + reach * abs(leaf.vv[2])) + rise * drift_vv;
  const D h_uv =
      e_uv + (az * drift_b + bz * drift_a + drift_a * drift_b + reach * abs(leaf.uv[2])) + rise * drift_uv;
  const D ha = (a[0] * a[0] + a[1] * a[1]) + (d.x * leaf.uu[0] + d.y * leaf.uu[1]) - h_uu - h_uv;
  const D hb = (a[0] * b[0] + a[1] * b[1]) + (d.x * leaf.uv[0] + d.y * leaf.uv[1]);
  const D hc = (b[0] * b[0] + b[1] * b[1]) + (d.x * leaf.vv[0] + d.y * leaf.vv[1]) - h_vv - h_uv;
  low.convex &= low.minorant | ((ha > 0.0) & (hc > 0.0) & (ha * hc > hb * hb));
  return low;
}

// As GuessMinimum.
PM_LANE_INLINE Minimum GuessMinimumLanes(const LaneLeaf& leaf, const V3& c, M wanted) {
  const D z = leaf.s[2] - c.z;
  const V3 d{leaf.s[0] - c.x, leaf.s[1] - c.y, Min(z, D{})};
  const double aa = Dot3(leaf.a, leaf.a), bb = Dot3(leaf.b, leaf.b), ab = Dot3(leaf.a, leaf.b);
  Quadratic q{aa + Dot(d, leaf.uu), ab + Dot(d, leaf.uv), bb + Dot(d, leaf.vv), Dot(d, leaf.a),
              Dot(d, leaf.b)};
  const M good = (q.a > 0.0) & (q.c > 0.0) & (q.a * q.c > 1.0001 * (q.b * q.b));
  q.a = good ? q.a : Splat(aa);
  q.b = good ? q.b : Splat(ab);
  q.c = good ? q.c : Splat(bb);
  const M start_in_middle = ~good & SplatInt(aa > 0.0 && bb > 0.0 && aa * bb > 1.0001 * ab * ab ? 0 : -1);
  const D half = Splat(0.5);
  Minimum guess = MinimizeOnBoxLanes(q, {-half, half, -half, half}, wanted & ~start_in_middle);
  guess.x = start_in_middle ? D{} : guess.x;
  guess.y = start_in_middle ? D{} : guess.y;
  return guess;
}

}  // namespace patchmill::internal::PM_LANES
