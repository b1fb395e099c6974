#include "cam/location/leaf_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "cam/location/bicubic_bounds.h"
#include "cam/location/gregory_bounds.h"

namespace patchmill::internal {
namespace {

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

// The polynomial case (w = 1), and the rational one by the quotient rule around the middle point:
//   S_u - a     = [(N_u - w0 a) - (w - w0) a - w_u (S - s)] / w,
//   S_uu - s_uu = [(N_uu - N_uu0) - 2 (w_u S_u - w_u0 a) - w_uu (S - s) - (w - w0) s_uu] / w,
// with N = w (S - s) and N_uu0 = w0 s_uu + 2 w_u0 a. Both hold for any constants w0, w_u0.
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

// The largest S - s over the hull: its length (squared), and its products with the model's vectors.
struct HullReach {
  double all2 = 0.0, a = 0.0, b = 0.0, uu = 0.0, uv = 0.0, vv = 0.0;
  double z_max = -kInfinity;
};
HullReach ReachOf(std::span<const Vec3> hull, const LeafModel& m) {
  HullReach r;
  for (const Vec3& p : hull) {
    const Vec3 d = p - m.s;
    r.z_max = std::max(r.z_max, p.z());
    r.all2 = std::max(r.all2, d.squaredNorm());
    r.a = std::max(r.a, std::abs(d.dot(m.a)));
    r.b = std::max(r.b, std::abs(d.dot(m.b)));
    r.uu = std::max(r.uu, std::abs(d.dot(m.uu)));
    r.uv = std::max(r.uv, std::abs(d.dot(m.uv)));
    r.vv = std::max(r.vv, std::abs(d.dot(m.vv)));
  }
  return r;
}

// A derivative of a net: how often by u and by v.
struct Order {
  int u, v;
};

// A first derivative of the model, with the bound of its weight's and of its deviation.
struct Slope {
  const Range& weight;
  const Vec3& first;
  double drift;
};

// Bounds how far the derivatives of a net deviate from those of its model.
class NetDeviation {
 public:
  NetDeviation(const Net& net, const WeightBounds& weights, const HullReach& reach, const LeafModel& model)
      : net_(net), w_(weights), reach_(reach), reach_all_(std::sqrt(reach.all2)), m_(model) {}

  // Bounds |S_i - first| for one direction i.
  Deviation First(const Order& order, const Vec3& first) const {
    Deviation d;
    ForEachDifference(net_, order.u, order.v, [&](const Vec4& x) {
      d.Add(x.head<3>() - x.w() * m_.s - w_.w.middle * first, m_.a, m_.b);
    });
    if (w_.constant()) return d;
    const double rate = (order.u == 1 ? w_.u : w_.v).Largest();
    const double length = (d.Length() + w_.w.spread * first.norm() + rate * reach_all_) / w_.min();
    d.length = length * length;
    d.along_a = (d.along_a + w_.w.spread * std::abs(first.dot(m_.a)) + rate * reach_.a) / w_.min();
    d.along_b = (d.along_b + w_.w.spread * std::abs(first.dot(m_.b)) + rate * reach_.b) / w_.min();
    return d;
  }

  // Bounds |S_ij - second|. The middle terms of the product rule are w_1 S_2 + w_2 S_1, once each, also if
  // i = j. `rate` is the range of w_ij.
  double Second(const Order& order, const Vec3& second, const Slope& s1, const Slope& s2,
                const Range& rate) const {
    const Vec3 middle = w_.w.middle * second + s1.weight.middle * s2.first + s2.weight.middle * s1.first;
    double d = 0.0;
    ForEachDifference(net_, order.u, order.v, [&](const Vec4& x) {
      d = std::max(d, (x.head<3>() - x.w() * m_.s - middle).squaredNorm());
    });
    d = std::sqrt(d);
    if (w_.constant()) return d;
    const auto mixed = [](const Range& weight, const Slope& s) {
      return weight.spread * s.first.norm() + weight.Largest() * s.drift;
    };
    return (d + mixed(s1.weight, s2) + mixed(s2.weight, s1) + rate.Largest() * reach_all_ +
            w_.w.spread * second.norm()) /
           w_.min();
  }

 private:
  const Net& net_;
  const WeightBounds& w_;
  const HullReach& reach_;
  const double reach_all_;
  const LeafModel& m_;
};

// How far derivatives deviate from those of the model.
struct Derivatives {
  Deviation du, dv;
  double uu = 0.0, uv = 0.0, vv = 0.0;
};

// nullopt where the weights of a singular corner leave no bound.
std::optional<Derivatives> BoundNetDerivatives(const Net& net, bool rational, const HullReach& reach,
                                               const LeafModel& m) {
  const WeightBounds w = rational ? BoundWeights(net) : WeightBounds{};
  if (!(w.min() > 1e-3 * w.w.middle)) return std::nullopt;
  const NetDeviation deviation(net, w, reach, m);
  Derivatives d;
  d.du = deviation.First({1, 0}, m.a);
  d.dv = deviation.First({0, 1}, m.b);
  const Slope su{w.u, m.a, d.du.Length()}, sv{w.v, m.b, d.dv.Length()};
  d.uu = deviation.Second({2, 0}, m.uu, su, su, w.uu);
  d.uv = deviation.Second({1, 1}, m.uv, su, sv, w.uv);
  d.vv = deviation.Second({0, 2}, m.vv, sv, sv, w.vv);
  return d;
}

// S = bicubic + sum phi_c D_c. With k_c the middle of a derivative's range, the bicubic deviates from
// middle - sum k_c D_c, and each term by the spread of its range.
std::optional<Derivatives> BoundGregory(const GregoryPatch& patch, const Rect& rect, const LeafModel& m) {
  std::array<Vec4, 16> points = BicubicPart(patch);
  RestrictNet({3, 3}, points.data(), rect);
  const Net net{{3, 3}, points.data()};
  const std::array<BlendedTerm, 4> terms = BoundBlend(patch, rect);
  const auto bound = [&](int ou, int ov, const Vec3& middle, Interval BlendedTerm::*range) {
    Vec3 bicubic = middle;
    for (const BlendedTerm& t : terms) bicubic -= (t.*range).middle() * t.d;
    Deviation d;
    ForEachDifference(net, ou, ov, [&](const Vec4& x) { d.Add(x.head<3>() - bicubic, m.a, m.b); });
    double length = d.Length();
    for (const BlendedTerm& t : terms) {
      const double spread = (t.*range).spread();
      length += spread * t.d.norm();
      d.along_a += spread * std::abs(t.d.dot(m.a));
      d.along_b += spread * std::abs(t.d.dot(m.b));
    }
    d.length = length * length;
    return d;
  };
  Derivatives d;
  d.du = bound(1, 0, m.a, &BlendedTerm::u);
  d.dv = bound(0, 1, m.b, &BlendedTerm::v);
  d.uu = bound(2, 0, m.uu, &BlendedTerm::uu).Length();
  d.uv = bound(1, 1, m.uv, &BlendedTerm::uv).Length();
  d.vv = bound(0, 2, m.vv, &BlendedTerm::vv).Length();
  return d;
}

LeafModel MiddleModel(const SurfaceJet& middle, const Rect& rect) {
  const double lu = rect.u1 - rect.u0, lv = rect.v1 - rect.v0;
  LeafModel m;
  m.s = middle.p;
  m.a = lu * middle.du;
  m.b = lv * middle.dv;
  m.uu = lu * lu * middle.duu;
  m.uv = lu * lv * middle.duv;
  m.vv = lv * lv * middle.dvv;
  return m;
}

void SetErrors(const HullReach& reach, const std::optional<Derivatives>& bounds, LeafModel& m) {
  m.reach = RoundUp(std::sqrt(reach.all2));
  m.z_max = reach.z_max;
  if (!bounds) return;
  const Deviation &du = bounds->du, &dv = bounds->dv;
  m.drift_a = RoundUp(du.Length());
  m.drift_b = RoundUp(dv.Length());
  m.drift_uu = RoundUp(bounds->uu);
  m.drift_uv = RoundUp(bounds->uv);
  m.drift_vv = RoundUp(bounds->vv);
  // S_u.S_u >= a.a + 2 (S_u - a).a, so only the part along a can make it smaller.
  m.gram_uu = RoundUp(2.0 * du.along_a + reach.uu);
  m.gram_vv = RoundUp(2.0 * dv.along_b + reach.vv);
  m.gram_uv = RoundUp(du.along_b + dv.along_a + du.Length() * dv.Length() + reach.uv);
}

// For most patches: the same bounds, several points at a time.
void SetErrorsOfBicubic(const double* points, LeafModel& m) {
  const BicubicBounds b =
      BoundBicubic(points, {m.s.data(), m.a.data(), m.b.data(), m.uu.data(), m.uv.data(), m.vv.data()});
  const Derivatives derivatives{
      {b.du2, b.du_a, b.du_b}, {b.dv2, b.dv_a, b.dv_b}, std::sqrt(b.uu2), std::sqrt(b.uv2), std::sqrt(b.vv2)};
  SetErrors({b.reach2, b.reach_a, b.reach_b, b.reach_uu, b.reach_uv, b.reach_vv, b.z_max}, derivatives, m);
}

// The lines of one parameter are nearly vertical.
bool IsSteep(const LeafModel& m) {
  constexpr double kSteep = 1e-3;  // squared slope from the vertical
  const auto steep = [](const Vec3& x) { return x.head<2>().squaredNorm() < kSteep * x.z() * x.z(); };
  return steep(m.a) || steep(m.b);
}

SurfaceJet Flat(SurfaceJet jet) {
  for (Vec3* x : {&jet.p, &jet.du, &jet.dv, &jet.duu, &jet.duv, &jet.dvv}) x->z() = 0.0;
  return jet;
}

// The errors of the projection of a net into the plan.
LeafErrors PlanErrors(const PartNet& net, const SurfaceJet& middle, const Rect& rect) {
  std::array<Vec4, kMaxNetPoints> points;
  std::array<Vec3, kMaxNetPoints> hull;
  const auto count = static_cast<std::size_t>(net.shape.count());
  for (std::size_t k = 0; k < count; ++k) {
    points[k] = net.points[k];
    points[k].z() = 0.0;
  }
  for (std::size_t k = 0; k < net.hull.size(); ++k) hull[k] = Lift(Xy(net.hull[k]), 0.0);
  LeafModel flat = MiddleModel(Flat(middle), rect);
  const HullReach reach = ReachOf({hull.data(), net.hull.size()}, flat);
  SetErrors(reach, BoundNetDerivatives({net.shape, points.data()}, net.rational, reach, flat), flat);
  return flat;
}

}  // namespace

LeafModel MakeLeafModel(const PartNet& net, const SurfaceJet& middle, const Rect& rect) {
  LeafModel m = MiddleModel(middle, rect);
  if (!net.rational && net.shape.degree_u == 3 && net.shape.degree_v == 3) {
    SetErrorsOfBicubic(net.points->data(), m);
    return m;
  }
  const HullReach reach = ReachOf(net.hull, m);
  SetErrors(reach, BoundNetDerivatives({net.shape, net.points}, net.rational, reach, m), m);
  if (IsSteep(m)) m.plan = PlanErrors(net, middle, rect);
  return m;
}

LeafModel MakeLeafModel(const Piece& piece, const Vec4* points, std::span<const Vec3> hull,
                        const Rect& rect) {
  const SurfaceJet middle = Evaluate(piece, 0.5 * (rect.u0 + rect.u1), 0.5 * (rect.v0 + rect.v1));
  if (!piece.gregory) {
    const NetShape shape{piece.net.degree_u, piece.net.degree_v};
    return MakeLeafModel({shape, points, piece.net.rational, hull}, middle, rect);
  }
  LeafModel m = MiddleModel(middle, rect);
  const HullReach reach = ReachOf(hull, m);
  SetErrors(reach, BoundGregory(*piece.gregory, rect, m), m);
  return m;
}

bool IsLongerAlongU(const LeafModel& model) {
  // A derivative below this share of its drift vanishes near the middle. It says nothing about the length
  // then.
  constexpr double kVanishing = 1e-3;
  const double a = model.a.norm(), b = model.b.norm();
  if (a < kVanishing * model.drift_a || b < kVanishing * model.drift_b) {
    return a + model.drift_a >= b + model.drift_b;
  }
  return model.a.squaredNorm() >= model.b.squaredNorm();
}

}  // namespace patchmill::internal
