// Curvature continuity along one edge by a virtual strip beside it ([references: konno1992]: basis
// patch method [joining (17)-(22)], connection formulas [joining (16), (23), (24)]).
//
// An edge runs over v in [0,1]. The strip crosses it with the derivatives a(v), A(v) of degree 2. A patch is
// joined to it when its first and second differences across the edge are, in degree n,
//   b(v) = k(v) a(v),   B(v) = k(v)^2 A(v) + l(v) a(v),          k, l of degree 2.            [joining (16)]
// Two patches joined to one strip have equal tangent planes and equal normal curvatures in every direction.
// All differences point INTO their own patch here, so k < 0 on the side that the strip comes from.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/base/vec.h"

namespace patchmill {

inline constexpr int kG2Degree = 6;  // n: cubic edges
inline constexpr double kControlPlace =
    0.5;  // v0 of [joining, section 8]: where the user's control vectors stand

// Direction and bend of the strip at one place of the edge.
struct StripPlace {
  Vec3 direction = Vec3::Zero();  // unit
  Vec3 bend = Vec3::Zero();       // across the direction: n / (n-1) times the curvature vector there
};

struct BasisStrip {
  std::array<Vec3, 3> a, A;  // Bernstein coefficients [joining (17)]
};

// The strip with the given places at v = 0, kControlPlace and 1: [joining (18)-(20)].
BasisStrip MakeBasisStrip(const StripPlace& start, const StripPlace& middle, const StripPlace& end);

// First and second control vector of a patch at one place of the edge: S_n/n and S_nn/(n(n-1)).
struct ControlVectors {
  Vec3 first = Vec3::Zero(), second = Vec3::Zero();
};

// The part of second/|first|^2 across `first`.
Vec3 BendOf(const ControlVectors& vectors);

struct ConnectionFactors {
  std::array<double, 3> k{}, l{};  // Bernstein coefficients of the k and l of [joining (16)]
};

// The factors that give the patch these vectors at the three places, as far as they fit the strip. nullopt
// where k(v) has a zero: the patch would fold at the edge.
std::optional<ConnectionFactors> FactorsFor(const BasisStrip& strip, const ControlVectors& start,
                                            const ControlVectors& middle, const ControlVectors& end);

// Bernstein coefficients of degree n, along the edge, of both differences into a patch. Its control points
// are P_1i = P_0i + first_i, P_2i = P_0i + 2 first_i + second_i.
struct CrossRows {
  std::array<Vec3, kG2Degree + 1> first, second;
};
CrossRows Connect(const BasisStrip& strip, const ConnectionFactors& factors);

// [joining (23), (24)] for any n >= 5: a_lower has degree n-2, A_lower degree n-4, b and B degree n.
struct ConnectedRows {
  std::vector<Vec3> b, B;
};
ConnectedRows ConnectRows(const ConnectionFactors& factors, const std::vector<Vec3>& a_lower,
                          const std::vector<Vec3>& A_lower);

}  // namespace patchmill
