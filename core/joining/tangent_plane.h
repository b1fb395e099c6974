// Tangent-plane continuity along one edge shared by two patches [joining, section 4].
//
// An edge curve C runs from P0 to P1. On either side a patch, a and b, has a cross-boundary tangent (CBT)
// pointing into it,
//   a(u) = phi0 a0 + phi1 Wa0 + psi0 a1 + psi1 (-Wa1)                                        [joining (3)]
// where a0, a1 are the outgoing tangents at P0, P1 of that patch's other edge there, and Wa0, Wa1 the twists
// as seen from their own vertex: a'(0) = Wa0, a'(1) = -Wa1. Quads and triangles are treated alike.
#pragma once

#include <array>
#include <variant>

#include <Eigen/Core>

#include "core/curve/bezier_chain.h"

namespace patchmill {

// The two patches' tangents at both ends, outgoing.
struct CrossTangents {
  Vec3 a0 = Vec3::Zero(), a1 = Vec3::Zero();
  Vec3 b0 = Vec3::Zero(), b1 = Vec3::Zero();
};

// l(u) C'(u) = h(u) a(u) + k(u) b(u) with all three linear in u [joining (4), (5)]; index 0, 1: the value at
// that end. They are scaled so that h + k = 2 at both ends, hence everywhere. Then [joining (7)] always has a
// solution.
struct JoinFactors {
  std::array<double, 2> l{}, h{}, k{};
};

enum class JoinFault {
  kParallel,  // at an end a tangent is parallel to the edge: no tangent plane, or none that serves both
  kFolded,    // both patches leave the edge to the same side
};

// Smallest share of h and k in h + k = 2, and smallest sine between tangents that span a plane.
inline constexpr double kMinJoinFactor = 1e-6;
inline constexpr double kMinTangentSine = 1e-6;

// [joining (5)] at both ends. `start`, `end`: C'(0) and C'(1), true derivatives. n0, n1: unit normals of the
// common tangent planes, in which all vectors lie; their sense does not matter.
std::variant<JoinFactors, JoinFault> FactorsAlong(const Vec3& start, const Vec3& end,
                                                  const CrossTangents& tangents, const Vec3& n0,
                                                  const Vec3& n1);

struct EdgeTwists {
  Vec3 a0 = Vec3::Zero(), a1 = Vec3::Zero();  // Wa0, Wa1
  Vec3 b0 = Vec3::Zero(), b1 = Vec3::Zero();
};

// [joining (8)]: twists that make the CBTs as linear as possible.
EdgeTwists WishedTwists(const CrossTangents& tangents);

// The three vector equations [joining (7)]: matrix (3 x 4, unknowns Wa0 Wa1 Wb0 Wb1) and right sides (rows).
struct TwistConditions {
  Eigen::Matrix<double, 3, 4> matrix;
  Eigen::Matrix3d right;
};
TwistConditions ConditionsFor(const HermiteCurve& edge, const CrossTangents& tangents,
                              const JoinFactors& factors);

// The twists nearest to `wished` (least sum of squares, [joining (9)]) that satisfy [joining (7)]. They are
// found by the Moore-Penrose inverse with relative cut-off kPseudoInverseCutoff, which covers rank 2 as well
// (a = -b at both ends and the like). Residual of [joining (7)] about 1e-15 of the tangents.
inline constexpr double kPseudoInverseCutoff = 1e-9;
EdgeTwists NearestTwists(const HermiteCurve& edge, const CrossTangents& tangents, const JoinFactors& factors,
                         const EdgeTwists& wished);

// The CBT [joining (3)] as a vector-valued cubic.
BezierCurve CrossBoundaryTangent(const Vec3& at0, const Vec3& twist0, const Vec3& at1, const Vec3& twist1);

// The CBT b where a is given everywhere: [joining (4)] solved for b with k = 1, so that b = l C' - h a. The
// linear l and h give it its ends b0, b1 ([joining (11)], with l for curves that do not cross the edge in one
// line). Exact. It has the degree of `edge`, which must be above that of `leading`, and the breaks of both.
BezierChain FollowingTangent(const BezierChain& edge, const BezierChain& leading, const JoinFactors& factors,
                             const Vec3& b0, const Vec3& b1);

// The additional term of a and b where the edge is not its own cubic Hermite part H: with h + k = 2, l (C' -
// H')/2 on each side restores [joining (4)] exactly. It is vector-valued, with the degree (3 at least) and
// the breaks of the edge; zero for a cubic. Where the edge's second derivative jumps, the derivative of this
// term jumps, too.
BezierChain CorrectionFor(const BezierChain& edge, const JoinFactors& factors);

}  // namespace patchmill
