// Cross rows of G2-Gregory patches along an edge: joined with equal curvature, alone, or with a tangent plane
// only.
#pragma once

#include <array>
#include <optional>
#include <variant>

#include "core/curve/curve.h"
#include "core/joining/basis_strip.h"

namespace patchmill {

// Derivatives of the curve that leaves an end of the edge into a face.
struct CrossEnd {
  Vec3 d = Vec3::Zero(), dd = Vec3::Zero();
};

// One side of an edge. `first`, `second`: wished derivatives of the surface across the edge into the face,
// at the edge's middle. By default they are those of `fair` (fair_middles.h), without it the means of the
// two ends [joining, section 8], turned to a direction that both sides can share.
struct CrossSide {
  CrossEnd start, end;
  std::optional<Vec3> first, second;
  std::optional<CrossEnd> fair = {};
};

struct CurvatureFault {
  enum class Kind {
    kDirection,      // the crossing curves do not continue in one line at an end; amount in rad
    kCurvature,      // they do, but bend differently; amount: share of the larger curvature vector or 1/|d|
    kTurn,           // the directions across the edge turn so far along it that a patch would fold
    kControlsDiffer  // both sides have wishes that contradict each other; amount as kDirection or
                     // kCurvature
  };
  Kind kind = Kind::kDirection;
  double amount = 0.0;
  bool at_end = false;
};

// Crossing curves count as one up to this misfit at an end, for both kinds of amount.
inline constexpr double kMaxCurveMisfit = 1e-9;

// Why the curves of a and b that cross the edge at one of its ends do not continue each other. nullopt if
// they do.
std::optional<CurvatureFault> CrossingFault(const CrossEnd& a, const CrossEnd& b, bool at_end);

// Both sides joined to one strip (basis_strip.h): equal tangent planes and normal curvatures all along.
std::variant<std::array<CrossRows, 2>, CurvatureFault> JoinCurvature(const CrossSide& a, const CrossSide& b);

// The rows of a side on its own, at a crease or a border.
std::variant<CrossRows, CurvatureFault> RowsAlone(const CrossSide& side);

// First differences from a cross-boundary tangent (degree <= kG2Degree) whose ends are those of `side`.
// Second differences are interpolated between those of the ends.
CrossRows RowsWithTangent(const BezierCurve& tangent, const CrossSide& side);

CrossRows Reversed(CrossRows rows);  // for the edge in the opposite direction

}  // namespace patchmill
