// Finds the places at which curves in space meet within a tolerance [crossing, section 1].
#pragma once

#include <vector>

#include <absl/status/statusor.h>

#include "core/base/run_context.h"
#include "core/crossing/drawn_curve.h"

namespace patchmill {

struct CurvePlace {
  int curve = 0;
  double t = 0.0;  // parameter of the chain
};

// Two places within the tolerance: a crossing, or an end on the other curve.
struct Meeting {
  CurvePlace a, b;
  double distance = 0.0;
};

// Two curves come within the tolerance along a stretch, and part again to the sides they came from.
struct Touch {
  CurvePlace a, b;
  double length = 0.0;
};

// A stretch of a curve that runs along a longer one. Its ends are meetings if they are not ends of the curve.
struct DoubledStretch {
  int curve = 0;
  double from = 0.0, to = 1.0;
  int by = 0;
  bool whole = false;  // nearly all of the curve
};

struct Crossings {
  std::vector<Meeting> meetings;
  std::vector<Touch> touches;
  std::vector<DoubledStretch> doubled;
};

// Exact curves are compared: places are refined until they move by less than 1e-12 of their curve. All lists
// are ordered by curves. Cost O(n log n) for n flat pieces of the curves plus the near pairs.
// INVALID_ARGUMENT if the tolerance makes more than kMaxFlatPieces of them; errors of `run`.
inline constexpr std::size_t kMaxFlatPieces = 1'000'000;
absl::StatusOr<Crossings> FindCrossings(const std::vector<DrawnCurve>& curves, double tolerance,
                                        const RunContext& run);

// Length of the chain between two parameters, to about 1e-4 of it.
double LengthBetween(const BezierChain& chain, double from, double to);

// The parameter of the chain's point nearest to p, sought from t.
double FootFrom(const BezierChain& chain, double t, const Vec3& p);

}  // namespace patchmill
