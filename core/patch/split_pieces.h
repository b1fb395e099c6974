// Cutting a patch into many pieces: its cost beforehand, and how to end it early.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/base/run_context.h"
#include "core/patch/piece.h"

namespace patchmill {

// As SplitIntoPieces(id, shape), but kinds of many pieces (B-spline, Brown) poll `run`. Once it is cancelled
// the pieces are incomplete, so the caller must check run.Check().
std::vector<Piece> SplitIntoPieces(PatchId id, const PatchShape& shape, const RunContext& run);
std::vector<Piece> SplitIntoPieces(PatchId id, const PatchShape&& shape, const RunContext& run) = delete;

// One parameter direction of a B-spline.
struct SplineDirection {
  int degree = 0;
  std::span<const double> knots;
};

// Number of control points of all Bezier pieces that a B-spline is cut into. The arguments may be invalid: 0
// if a degree is outside 1..kMaxDegree. Cost O(knots).
std::size_t CountSplinePiecePoints(const SplineDirection& u, const SplineDirection& v);

}  // namespace patchmill
