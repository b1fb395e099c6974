#include "cam/location/bicubic_bounds.h"

#include <cstddef>
#include <cstring>

#include "core/base/instruction_set.h"

// Functions that take or return vectors are always inlined, so no calling convention for vectors is needed.
#pragma GCC diagnostic ignored "-Wpsabi"

#define PM_LANE_INLINE inline __attribute__((always_inline))

namespace patchmill::internal {
namespace {

using Two = double __attribute__((vector_size(16)));
using Four = double __attribute__((vector_size(32)));

constexpr std::size_t kRow = 4;

// One coordinate of every control point, row after row. One more row is added, so that whole rows can be read
// with an offset.
struct Numbers {
  double of[5 * kRow];
};
struct Grid {
  Numbers x[3];
};

// The coordinates of the control points, along v first or, if `turned`, along u first.
PM_LANE_INLINE void Sort(const double* points, bool turned, Grid& grid) {
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < kRow; ++i) {
      for (std::size_t j = 0; j < kRow; ++j)
        grid.x[k].of[kRow * i + j] = points[16 * (turned ? j : i) + 4 * (turned ? i : j) + k];
    }
    for (std::size_t j = 0; j < kRow; ++j) grid.x[k].of[kRow * kRow + j] = 0.0;
  }
}

template <class Lanes>
struct Vectors {
  Lanes x[3];
};

template <class Lanes>
PM_LANE_INLINE Lanes Load(const double* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}
template <class Lanes>
PM_LANE_INLINE Lanes Dot(const Vectors<Lanes>& d, const double* v) {
  return d.x[0] * v[0] + d.x[1] * v[1] + d.x[2] * v[2];
}
template <class Lanes>
PM_LANE_INLINE void RaiseTo(Lanes& most, Lanes x) {
  most = most > x ? most : x;
}
template <class Lanes>
PM_LANE_INLINE void RaiseToAbs(Lanes& most, Lanes x) {
  RaiseTo(most, x < 0.0 ? -x : x);
}
template <class Lanes>
PM_LANE_INLINE Lanes Squared(const Vectors<Lanes>& d) {
  return d.x[0] * d.x[0] + d.x[1] * d.x[1] + d.x[2] * d.x[2];
}
template <class Lanes>
PM_LANE_INLINE double Largest(const Lanes& lanes) {
  double most = lanes[0];
  for (std::size_t k = 1; k < sizeof(Lanes) / sizeof(double); ++k) most = most > lanes[k] ? most : lanes[k];
  return most + 0.0;  // the sign of a zero does not matter
}

// Visits the differences of this order along the grid's rows, less `middle`, as many as there are lanes at a
// time.
template <class Lanes, class Take>
PM_LANE_INLINE void Differences(const Grid& grid, std::size_t order, const double* middle, const Take& take) {
  constexpr std::size_t kWidth = sizeof(Lanes) / sizeof(double);
  for (std::size_t at = 0; at < (kRow - order) * kRow; at += kWidth) {
    Vectors<Lanes> d;
    for (std::size_t k = 0; k < 3; ++k) {
      const double* x = grid.x[k].of + at;
      const Lanes x0 = Load<Lanes>(x), x1 = Load<Lanes>(x + kRow);
      d.x[k] = order == 1 ? 3.0 * (x1 - x0) - middle[k]
                          : 6.0 * ((Load<Lanes>(x + 2 * kRow) - x1) - (x1 - x0)) - middle[k];
    }
    take(d);
  }
}

template <class Lanes>
PM_LANE_INLINE void BoundReach(const Grid& grid, const ModelVectors& m, BicubicBounds& out) {
  constexpr std::size_t kWidth = sizeof(Lanes) / sizeof(double);
  Lanes all{}, a{}, b{}, uu{}, uv{}, vv{}, z = Load<Lanes>(grid.x[2].of);
  for (std::size_t at = 0; at < kRow * kRow; at += kWidth) {
    Vectors<Lanes> d;
    for (std::size_t k = 0; k < 3; ++k) d.x[k] = Load<Lanes>(grid.x[k].of + at) - m.s[k];
    RaiseTo(z, Load<Lanes>(grid.x[2].of + at));
    RaiseTo(all, Squared(d));
    RaiseToAbs(a, Dot(d, m.a));
    RaiseToAbs(b, Dot(d, m.b));
    RaiseToAbs(uu, Dot(d, m.uu));
    RaiseToAbs(uv, Dot(d, m.uv));
    RaiseToAbs(vv, Dot(d, m.vv));
  }
  out.z_max = Largest(z);
  out.reach2 = Largest(all);
  out.reach_a = Largest(a);
  out.reach_b = Largest(b);
  out.reach_uu = Largest(uu);
  out.reach_uv = Largest(uv);
  out.reach_vv = Largest(vv);
}

// The largest deviations of the derivatives along the rows of a grid, as in BicubicBounds.
struct RowBounds {
  double first2, first_a, first_b, second2;
};

// Bounds first and second derivatives along the rows of the grid.
template <class Lanes>
PM_LANE_INLINE RowBounds BoundAlong(const Grid& grid, const ModelVectors& m, const double* first,
                                    const double* second) {
  Lanes all{}, a{}, b{}, bend{};
  Differences<Lanes>(
      grid, 1, first, [&](const Vectors<Lanes>& d) __attribute__((always_inline)) {
        RaiseTo(all, Squared(d));
        RaiseToAbs(a, Dot(d, m.a));
        RaiseToAbs(b, Dot(d, m.b));
      });
  Differences<Lanes>(
      grid, 2,
      second, [&](const Vectors<Lanes>& d) __attribute__((always_inline)) { RaiseTo(bend, Squared(d)); });
  return {Largest(all), Largest(a), Largest(b), Largest(bend)};
}

template <class Lanes>
PM_LANE_INLINE void BoundMixed(const Grid& grid, const ModelVectors& m, double& mixed2) {
  constexpr std::size_t kWidth = sizeof(Lanes) / sizeof(double);
  constexpr double kInRow[kRow] = {1.0, 1.0, 1.0, 0.0};  // no difference begins at the end of a row
  Lanes all{};
  for (std::size_t at = 0; at < (kRow - 1) * kRow; at += kWidth) {
    Vectors<Lanes> d;
    for (std::size_t k = 0; k < 3; ++k) {
      const double* x = grid.x[k].of + at;
      const Lanes low = Load<Lanes>(x + 1) - Load<Lanes>(x),
                  high = Load<Lanes>(x + kRow + 1) - Load<Lanes>(x + kRow);
      d.x[k] = (9.0 * (high - low) - m.uv[k]) * Load<Lanes>(kInRow + at % kRow);
    }
    RaiseTo(all, Squared(d));
  }
  mixed2 = Largest(all);
}

template <class Lanes>
PM_LANE_INLINE BicubicBounds Bound(const double* points, const ModelVectors& m) {
  Grid along_v, along_u;  // rows of equal u, of equal v
  Sort(points, false, along_v);
  Sort(points, true, along_u);
  BicubicBounds out;
  BoundReach<Lanes>(along_v, m, out);
  const RowBounds u = BoundAlong<Lanes>(along_v, m, m.a, m.uu), v = BoundAlong<Lanes>(along_u, m, m.b, m.vv);
  out.du2 = u.first2, out.du_a = u.first_a, out.du_b = u.first_b, out.uu2 = u.second2;
  out.dv2 = v.first2, out.dv_a = v.first_a, out.dv_b = v.first_b, out.vv2 = v.second2;
  BoundMixed<Lanes>(along_v, m, out.uv2);
  return out;
}

#ifdef PATCHMILL_X86_VECTORS
__attribute__((target("avx2"))) BicubicBounds BoundWithAvx2(const double* points, const ModelVectors& m) {
  return Bound<Four>(points, m);
}
#endif

}  // namespace

BicubicBounds BoundBicubic(const double* points, const ModelVectors& model) {
#ifdef PATCHMILL_X86_VECTORS
  if (UsedInstructionSet() != InstructionSet::kPlain) return BoundWithAvx2(points, model);
#endif
  return Bound<Two>(points, model);
}

}  // namespace patchmill::internal
