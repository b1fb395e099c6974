#include "cam/location/leaf_model.h"

#include <algorithm>
#include <cmath>

namespace patchmill::internal {
namespace {

constexpr Box2 kUnit{-0.5, 0.5, -0.5, 0.5};

// Largest deviation of a family of differences of the net from a fixed vector: its length, and its parts
// along two directions.
struct Deviation {
  double length = 0.0, along_a = 0.0, along_b = 0.0;
  void Add(const Vec3& d, const Vec3& a, const Vec3& b) {
    length = std::max(length, d.squaredNorm());
    along_a = std::max(along_a, std::abs(d.dot(a)));
    along_b = std::max(along_b, std::abs(d.dot(b)));
  }
  double Length() const { return std::sqrt(length); }
};

struct Net {
  NetShape shape;
  const Vec4* points;
  const Vec4& At(int i, int j) const { return points[i * (shape.degree_v + 1) + j]; }
};

// Calls take(x) for every control point of the derivative net of order (ou, ov), ou + ov <= 2.
template <class Take>
void ForEachDifference(const Net& net, int ou, int ov, const Take& take) {
  const int n = net.shape.degree_u, m = net.shape.degree_v;
  if (n < ou || m < ov) return take(Vec4(Vec4::Zero()));
  double factor = 1.0;
  for (int k = 0; k < ou; ++k) factor *= n - k;
  for (int k = 0; k < ov; ++k) factor *= m - k;
  for (int i = 0; i + ou <= n; ++i) {
    for (int j = 0; j + ov <= m; ++j) {
      Vec4 d;
      if (ou == 2) {
        d = net.At(i + 2, j) - 2.0 * net.At(i + 1, j) + net.At(i, j);
      } else if (ov == 2) {
        d = net.At(i, j + 2) - 2.0 * net.At(i, j + 1) + net.At(i, j);
      } else if (ou == 1 && ov == 1) {
        d = net.At(i + 1, j + 1) - net.At(i + 1, j) - net.At(i, j + 1) + net.At(i, j);
      } else {
        d = (ou == 1 ? net.At(i + 1, j) : net.At(i, j + 1)) - net.At(i, j);
      }
      take(Vec4(factor * d));
    }
  }
}

// The polynomial case (w = 1) and the rational one by the quotient rule around the middle point:
//   S_u - a     = [(N_u - w0 a) - (w - w0) a - w_u (S - s)] / w,
//   S_uu - s_uu = [(N_uu - N_uu0) - 2 (w_u S_u - w_u0 a) - w_uu (S - s) - (w - w0) s_uu] / w,
// with N = w (S - s) and N_uu0 = w0 s_uu + 2 w_u0 a; true for any constants w0, w_u0.
struct Range {
  double middle = 0.0, spread = 0.0;  // |value - middle| <= spread
  double Largest() const { return std::abs(middle) + spread; }
};
struct WeightBounds {
  Range w{1.0, 0.0}, u, v, uu, uv, vv;
  bool constant() const { return w.spread == 0.0; }
  double min() const { return w.middle - w.spread; }
};

WeightBounds BoundWeights(const Net& net) {
  const auto range = [&](int ou, int ov) {
    double lo = kInfinity, hi = -kInfinity;
    ForEachDifference(net, ou, ov, [&](const Vec4& d) {
      lo = std::min(lo, d.w());
      hi = std::max(hi, d.w());
    });
    return Range{0.5 * (lo + hi), 0.5 * (hi - lo)};
  };
  double lo = kInfinity, hi = -kInfinity;
  for (int k = 0; k < net.shape.count(); ++k) {
    lo = std::min(lo, net.points[k].w());
    hi = std::max(hi, net.points[k].w());
  }
  return {
      {0.5 * (lo + hi), 0.5 * (hi - lo)}, range(1, 0), range(0, 1), range(2, 0), range(1, 1), range(0, 2)};
}

// Bounds |S_i - first| for one direction i.
Deviation BoundFirst(const Net& net, int ou, const Vec3& first, const LeafModel& m, const WeightBounds& w,
                     double reach_a, double reach_b) {
  Deviation d;
  ForEachDifference(net, ou, 1 - ou,
                    [&](const Vec4& x) { d.Add(x.head<3>() - x.w() * m.s - w.w.middle * first, m.a, m.b); });
  if (w.constant()) return d;
  const double rate = (ou == 1 ? w.u : w.v).Largest();
  const double length = (d.Length() + w.w.spread * first.norm() + rate * m.reach) / w.min();
  d.length = length * length;
  d.along_a = (d.along_a + w.w.spread * std::abs(first.dot(m.a)) + rate * reach_a) / w.min();
  d.along_b = (d.along_b + w.w.spread * std::abs(first.dot(m.b)) + rate * reach_b) / w.min();
  return d;
}

// Bounds |S_ij - second|. The product rule's middle terms are w_1 S_2 + w_2 S_1 (once each, also when i = j).
struct Slope {
  const Range& weight;
  const Vec3& first;
  double drift;
};
double BoundSecond(const Net& net, int ou, int ov, const Vec3& second, const LeafModel& m,
                   const WeightBounds& w, const Slope& s1, const Slope& s2, const Range& rate) {
  const Vec3 middle = w.w.middle * second + s1.weight.middle * s2.first + s2.weight.middle * s1.first;
  double d = 0.0;
  ForEachDifference(net, ou, ov, [&](const Vec4& x) {
    d = std::max(d, (x.head<3>() - x.w() * m.s - middle).squaredNorm());
  });
  d = std::sqrt(d);
  if (w.constant()) return d;
  const auto mixed = [](const Range& weight, const Slope& s) {
    return weight.spread * s.first.norm() + weight.Largest() * s.drift;
  };
  return (d + mixed(s1.weight, s2) + mixed(s2.weight, s1) + rate.Largest() * m.reach +
          w.w.spread * second.norm()) /
         w.min();
}

}  // namespace

LeafModel MakeLeafModel(NetShape shape, const Vec4* points, bool rational, const Vec3* hull, int hull_count,
                        const SurfaceJet& middle, const Rect& rect) {
  const double lu = rect.u1 - rect.u0, lv = rect.v1 - rect.v0;
  LeafModel m;
  m.s = middle.p;
  m.a = lu * middle.du;
  m.b = lv * middle.dv;
  m.uu = lu * lu * middle.duu;
  m.uv = lu * lv * middle.duv;
  m.vv = lv * lv * middle.dvv;

  double reach2 = 0.0, uu = 0.0, uv = 0.0, vv = 0.0, reach_a = 0.0, reach_b = 0.0;
  double z_max = -kInfinity;
  for (int k = 0; k < hull_count; ++k) {
    const Vec3 d = hull[k] - m.s;
    z_max = std::max(z_max, hull[k].z());
    reach2 = std::max(reach2, d.squaredNorm());
    reach_a = std::max(reach_a, std::abs(d.dot(m.a)));
    reach_b = std::max(reach_b, std::abs(d.dot(m.b)));
    uu = std::max(uu, std::abs(d.dot(m.uu)));
    uv = std::max(uv, std::abs(d.dot(m.uv)));
    vv = std::max(vv, std::abs(d.dot(m.vv)));
  }
  m.reach = RoundUp(std::sqrt(reach2));
  m.z_max = RoundUp(z_max);

  const Net net{shape, points};
  const WeightBounds w = rational ? BoundWeights(net) : WeightBounds{};
  if (!(w.min() > 1e-3 * w.w.middle)) return m;  // a singular corner: derivatives have no useful bound
  const Deviation du = BoundFirst(net, 1, m.a, m, w, reach_a, reach_b);
  const Deviation dv = BoundFirst(net, 0, m.b, m, w, reach_a, reach_b);
  m.drift_a = RoundUp(du.Length());
  m.drift_b = RoundUp(dv.Length());
  const Slope su{w.u, m.a, m.drift_a}, sv{w.v, m.b, m.drift_b};
  m.drift_uu = RoundUp(BoundSecond(net, 2, 0, m.uu, m, w, su, su, w.uu));
  m.drift_uv = RoundUp(BoundSecond(net, 1, 1, m.uv, m, w, su, sv, w.uv));
  m.drift_vv = RoundUp(BoundSecond(net, 0, 2, m.vv, m, w, sv, sv, w.vv));
  // S_u.S_u >= a.a + 2 (S_u - a).a: only the part along a can make it smaller.
  m.gram_uu = RoundUp(2.0 * du.along_a + uu);
  m.gram_vv = RoundUp(2.0 * dv.along_b + vv);
  m.gram_uv = RoundUp(du.along_b + dv.along_a + du.Length() * dv.Length() + uv);
  return m;
}

LowerModel BoundBelow(const LeafModel& m, const Vec3& c) {
  LowerModel low;
  const Vec3 d = m.s - c;
  const double distance2 = d.squaredNorm();
  const double size = std::sqrt(distance2) + m.reach, drift_a = m.drift_a, drift_b = m.drift_b;
  const double e_uu = m.gram_uu + size * m.drift_uu, e_uv = m.gram_uv + size * m.drift_uv,
               e_vv = m.gram_vv + size * m.drift_vv;
  low.f0 = 0.5 * distance2;
  low.q.a = m.a.squaredNorm() + d.dot(m.uu) - e_uu - e_uv;
  low.q.b = m.a.dot(m.b) + d.dot(m.uv);
  low.q.c = m.b.squaredNorm() + d.dot(m.vv) - e_vv - e_uv;
  low.q.gx = d.dot(m.a);
  low.q.gy = d.dot(m.b);
  low.convex = low.q.a > 0.0 && low.q.c > 0.0 && low.q.a * low.q.c > low.q.b * low.q.b;
  low.minorant = m.z_max <= c.z();
  if (low.minorant || !low.convex) return low;

  // The part above c is measured horizontally: there the Hessian lacks z_i z_j + (z - c_z) z_ij. f is once
  // differentiable across the level of c, so it is convex when both Hessians are positive definite.
  const double az = std::abs(m.a.z()), bz = std::abs(m.b.z());
  const double rise = std::abs(d.z()) + m.reach;
  const double h_uu =
      e_uu + 2.0 * az * drift_a + drift_a * drift_a + rise * m.drift_uu + m.reach * std::abs(m.uu.z());
  const double h_vv =
      e_vv + 2.0 * bz * drift_b + drift_b * drift_b + rise * m.drift_vv + m.reach * std::abs(m.vv.z());
  const double h_uv = e_uv + az * drift_b + bz * drift_a + drift_a * drift_b + rise * m.drift_uv +
                      m.reach * std::abs(m.uv.z());
  const double a = m.a.head<2>().squaredNorm() + d.head<2>().dot(m.uu.head<2>()) - h_uu - h_uv;
  const double b = m.a.head<2>().dot(m.b.head<2>()) + d.head<2>().dot(m.uv.head<2>());
  const double cc = m.b.head<2>().squaredNorm() + d.head<2>().dot(m.vv.head<2>()) - h_vv - h_uv;
  low.convex = a > 0.0 && cc > 0.0 && a * cc > b * b;
  return low;
}

BoxMinimum GuessMinimum(const LeafModel& m, const Vec3& c) {
  Vec3 d = m.s - c;
  if (d.z() > 0.0) d.z() = 0.0;  // above c only the horizontal distance counts
  Quadratic2 q;
  const double aa = m.a.squaredNorm(), bb = m.b.squaredNorm(), ab = m.a.dot(m.b);
  q.a = aa + d.dot(m.uu);
  q.b = ab + d.dot(m.uv);
  q.c = bb + d.dot(m.vv);
  q.gx = d.dot(m.a);
  q.gy = d.dot(m.b);
  if (!(q.a > 0.0 && q.c > 0.0 && q.a * q.c > 1.0001 * q.b * q.b)) {
    q.a = aa;
    q.b = ab;
    q.c = bb;
    if (!(aa > 0.0 && bb > 0.0 && aa * bb > 1.0001 * ab * ab)) return {0.0, 0.0, 0.0};
  }
  return MinimizeOnBox(q, kUnit);
}

}  // namespace patchmill::internal
